// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit_problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

std::vector<std::string> Names(const std::vector<ParameterInfo>& infos) {
  std::vector<std::string> names;
  for (const ParameterInfo& info : infos) names.emplace_back(info.name);
  return names;
}

TEST(FitParameters, StandInTheOrderOfTheResult) {
  const MotionModel coulomb = Must(FindMotionModel("coulomb"));
  EXPECT_THAT(Names(FitParameters(coulomb, StartKind::kRelease, Quantity::kAngle)),
              testing::ElementsAre("inertia", "viscous", "coulomb", "release_angle", "release_time", "zero_angle"));
  EXPECT_THAT(Names(FitParameters(coulomb, StartKind::kMoving, Quantity::kRate)),
              testing::ElementsAre("inertia", "viscous", "coulomb", "initial_angle", "initial_rate", "rate_bias"));
}

TEST(MakeFitProblem, CountsTimesFromTheFirstSampleAndKeepsItsClock) {
  SyntheticOptions options = TextbookRun("viscous");
  options.start_time = 1.6e9;
  options.release_time = 1.6e9 + 1.9;
  const FitProblem problem = Must(MakeFitProblem(Must(SimulateRecording(options)), ModelOptions("viscous")));
  EXPECT_EQ(problem.data.time.front(), 0);
  EXPECT_THAT(problem.first_guess[3], DoubleNear(1.9, 0.02));
  EXPECT_EQ(problem.offset[3], 1.6e9);
  EXPECT_EQ(problem.offset[2], 0);
}

TEST(MakeFitProblem, TakesFixedValuesInSiAndHoldsThem) {
  FitOptions options = ModelOptions("coulomb");
  options.rig.emplace();
  options.rig->gravity_torque = {2.0, 0};
  options.fixed = {{"viscous", 0.004}, {"release_time", 1.9}};
  const FitProblem problem = Must(MakeFitProblem(Must(SimulateRecording(TextbookRun("coulomb"))), options));
  EXPECT_DOUBLE_EQ(problem.first_guess[1], 0.002);  // in units of G = 2 N m
  EXPECT_DOUBLE_EQ(problem.first_guess[4], 1.9);    // a time has no G
  EXPECT_THAT(problem.solve.fixed, testing::ElementsAre(false, true, false, false, true, false));
}

TEST(MakeFitProblem, KnowsWhichParameterHoldsThePendulumAtRest) {
  const Recording recording = Must(SimulateRecording(TextbookRun("viscous")));
  EXPECT_EQ(Must(MakeFitProblem(recording, ModelOptions("viscous"))).solve.holding_parameter, -1);
  EXPECT_EQ(Must(MakeFitProblem(recording, ModelOptions("coulomb"))).solve.holding_parameter, 2);
}

TEST(MakeFitProblem, RefusesNamesAndValuesTheModelDoesNotHave) {
  const Recording recording = Must(SimulateRecording(TextbookRun("viscous")));
  FitOptions options = ModelOptions("viscous");
  options.fixed = {{"coulomb", 0.0}};
  const Status unknown = MakeFitProblem(recording, options).error();
  EXPECT_EQ(unknown.code, StatusCode::kInvalidArgument);
  EXPECT_THAT(unknown.message, HasSubstr("'coulomb'"));
  EXPECT_THAT(unknown.message, HasSubstr("inertia, viscous, release_angle, release_time, zero_angle"));
  options.fixed = {{"viscous", -1.0}};
  EXPECT_THAT(MakeFitProblem(recording, options).error().message, HasSubstr("viscous cannot be fixed at -1"));
  options.fixed = {{"inertia", 0.0}};
  EXPECT_THAT(MakeFitProblem(recording, options).error().message, HasSubstr("it must be positive"));
}

}  // namespace
}  // namespace pendulum
