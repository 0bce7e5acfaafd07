// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/fit_problem.h"

#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::fit_problem_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::Lt;

FitProblem ProblemOf(const SyntheticOptions& run, const FitOptions& options) {
  return Must(MakeFitProblem(Must(SimulateRecording(run)), options));
}

Status RefusalOf(const SyntheticOptions& run, const FitOptions& options) {
  const auto problem = MakeFitProblem(Must(SimulateRecording(run)), options);
  return problem ? Status{StatusCode::kInternal, "it was accepted"} : problem.error();
}

FitOptions Fixing(std::string_view model, const ParameterValues& fixed) {
  FitOptions options = ModelOptions(model);
  options.fixed = fixed;
  return options;
}

Rig RigOf(double gravity_torque) {
  return Must(ParseRig("{\"gravity_torque\": " + std::to_string(gravity_torque) + "}", "rig.json"));
}

// ---- Parameters ----------------------------------------------------------------------------------------------------

TEST(MakeFitProblem, ListsTheModelsForAnUnknownName) {
  const Status status = RefusalOf(TextbookRun("coulomb"), ModelOptions("columb"));
  EXPECT_EQ(status.code, StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("columb"));
  for (const MotionModel& model : MotionModels()) EXPECT_THAT(status.message(), HasSubstr(std::string(model.name)));
}

TEST(MakeFitProblem, BoundsFrictionAtZeroAndTheReleaseByTheHold) {
  const FitProblem problem = ProblemOf(TextbookRun("drag"), ModelOptions("drag"));
  EXPECT_THAT(problem.solve.lower, ElementsAre(-kUnbounded, 0, 0, 0, -kUnbounded, 0, -kUnbounded));
  const std::vector<double>& upper = problem.solve.upper;
  EXPECT_THAT(upper[5], AllOf(Gt(1.9), Lt(2.1)));  // released at 1.9 s, visibly in motion soon after
  EXPECT_THAT((std::vector{upper[0], upper[1], upper[2], upper[3], upper[4], upper[6]}), Each(kUnbounded));
  EXPECT_THAT(problem.solve.fixed, Each(false));
}

TEST(MakeFitProblem, FindsTheFrictionParameterThatHoldsThePendulumAtRest) {
  const std::map<std::string_view, int> expected = {{"linear", -1}, {"viscous", -1}, {"coulomb", 2}, {"drag", 2}};
  for (const auto& [model, holding] : expected) {
    EXPECT_EQ(ProblemOf(TextbookRun(model), ModelOptions(model)).solve.holding_parameter, holding) << model;
  }
}

// ---- Data and units ------------------------------------------------------------------------------------------------

TEST(MakeFitProblem, MeasuresTimeFromTheFirstSampleButReportsFileTime) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.start_time = 1000;
  run.release_time = 1001.9;
  const FitProblem problem = ProblemOf(run, ModelOptions("coulomb"));
  EXPECT_EQ(problem.data.time.front(), 0);
  EXPECT_THAT(problem.data.time.back(), DoubleNear(19.99, 1e-9));
  EXPECT_THAT(problem.offset, ElementsAre(0, 0, 0, 0, 1000, 0));
  EXPECT_THAT(problem.first_guess[4], DoubleNear(1.9, 0.02));
}

TEST(MakeFitProblem, ScalesOnlyTorqueParametersWithGravity) {
  FitOptions options = ModelOptions("drag");
  EXPECT_THAT(ProblemOf(TextbookRun("drag"), options).si_per_internal, Each(1.0));
  options.rig = RigOf(2.5);
  EXPECT_THAT(ProblemOf(TextbookRun("drag"), options).si_per_internal, ElementsAre(2.5, 2.5, 2.5, 2.5, 1, 1, 1));
}

TEST(MakeFitProblem, MeasuresResidualsInUnitsOfTheNoise) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.noise = 0.004;
  const FitProblem noisy = ProblemOf(run, ModelOptions("coulomb"));
  EXPECT_THAT(noisy.data.scale, DoubleNear(0.004, 4e-4));
  run.noise = 0;
  EXPECT_GT(ProblemOf(run, ModelOptions("coulomb")).data.scale, 0);  // also without noise
}

TEST(MakeFitProblem, PassesTheIterationLimit) {
  FitOptions options = ModelOptions("coulomb");
  options.search.max_iterations = 7;
  EXPECT_EQ(ProblemOf(TextbookRun("coulomb"), options).solve.max_iterations, 7);
}

// ---- Fixed parameters ----------------------------------------------------------------------------------------------

TEST(MakeFitProblem, HoldsAFixedParameterAtItsValue) {
  const FitProblem problem = ProblemOf(TextbookRun("coulomb"), Fixing("coulomb", {{"coulomb", 0.0031}}));
  EXPECT_THAT(problem.solve.fixed, ElementsAre(false, false, true, false, false, false));
  EXPECT_EQ(problem.first_guess[2], 0.0031);
  EXPECT_NE(problem.start.parameters[2], 0.0031);  // the estimate from the data is also stored
}

TEST(MakeFitProblem, AcceptsFixedValuesInReportUnits) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.start_time = 1000;
  run.release_time = 1001.9;
  FitOptions options = Fixing("coulomb", {{"inertia", 0.079}, {"release_time", 1001.88}, {"zero_angle", 0.02}});
  options.rig = RigOf(2.5);
  const FitProblem problem = ProblemOf(run, options);
  EXPECT_THAT(problem.first_guess[0], DoubleNear(0.079 / 2.5, 1e-15));
  EXPECT_THAT(problem.first_guess[4], DoubleNear(1.88, 1e-9));
  EXPECT_EQ(problem.first_guess[5], 0.02);
}

TEST(MakeFitProblem, ListsTheParametersIfTheModelLacksTheFixedParameter) {
  const Status status = RefusalOf(TextbookRun("viscous"), Fixing("viscous", {{"coulomb", 0.001}}));
  EXPECT_EQ(status.code, StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), AllOf(HasSubstr("viscous has no parameter 'coulomb'"),
                                      HasSubstr("inertia, viscous, release_angle, release_time, zero_angle")));
}

TEST(MakeFitProblem, RefusesToFixAParameterOfTheOtherKindOfStart) {
  const Status status = RefusalOf(TextbookRun("viscous"), Fixing("viscous", {{"initial_angle", 0.4}}));
  EXPECT_EQ(status.code, StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("'initial_angle'"));
}

TEST(MakeFitProblem, RefusesToFixAValueOutsideItsBounds) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<std::string, double> refused[] = {{"viscous", -1e-6}, {"coulomb", -1.0},   {"inertia", 0.0},
                                                    {"inertia", -0.1},  {"zero_angle", nan}, {"viscous", infinity}};
  for (const auto& [name, value] : refused) {
    const Status status = RefusalOf(TextbookRun("coulomb"), Fixing("coulomb", {{name, value}}));
    EXPECT_EQ(status.code, StatusCode::kInvalidArgument) << name << " " << value;
    EXPECT_THAT(status.message(), HasSubstr(name + " cannot be fixed at")) << value;
  }
  EXPECT_THAT(RefusalOf(TextbookRun("coulomb"), Fixing("coulomb", {{"inertia", 0.0}})).message(),
              HasSubstr("greater than 1e-30"));
  EXPECT_THAT(RefusalOf(TextbookRun("coulomb"), Fixing("coulomb", {{"coulomb", -1.0}})).message(),
              HasSubstr("at least 0"));
}

TEST(MakeFitProblem, RefusesToFixTheReleaseOutsideTheHold) {
  for (const double time : {-0.1, 5.0}) {
    const Status status = RefusalOf(TextbookRun("coulomb"), Fixing("coulomb", {{"release_time", time}}));
    EXPECT_EQ(status.code, StatusCode::kInvalidArgument) << time;
    EXPECT_THAT(status.message(), HasSubstr("release_time cannot be fixed at")) << time;
    EXPECT_THAT(status.message(), HasSubstr("it must be at least 0 and at most ")) << time;
  }
}

TEST(MakeFitProblem, AcceptsFrictionFixedAtItsBound) {
  const FitProblem problem = ProblemOf(TextbookRun("coulomb"), Fixing("coulomb", {{"coulomb", 0.0}}));
  EXPECT_EQ(problem.first_guess[2], 0);
}

// ---- Noise ---------------------------------------------------------------------------------------------------------

Status NoiseRefusal(double resolution) {
  Recording recording = Must(SimulateRecording(NoisyRun("viscous")));
  recording.resolution = resolution;
  FitOptions options = ModelOptions("viscous");
  options.noise = NoiseFamily::kQuantized;
  const auto refused = MakeFitProblem(recording, options);
  return refused ? Status{StatusCode::kInternal, "accepted"} : refused.error();
}

TEST(MakeFitProblem, RefusesQuantizedNoiseWithoutAResolution) {
  const Status status = NoiseRefusal(0);
  EXPECT_EQ(status.code, StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(),
            "--noise quantized needs the resolution of the readings, but the readings show no discrete levels; give "
            "--resolution");
}

TEST(MakeFitProblem, CensorsReadingsBeyondTheEdgeOfTheLastLevelWithinTheRange) {
  SyntheticOptions run = NoisyRun();
  run.resolution = kCount;
  run.range = SensorRange{-0.32, 0.32};  // 92.4 levels on each side of 0
  Recording recording = Must(SimulateRecording(run));
  const FitProblem cut = Must(MakeFitProblem(recording, ModelOptions("coulomb")));
  const double highest = recording.value.maxCoeff();
  const double lowest = recording.value.minCoeff();
  EXPECT_EQ(cut.censored, (recording.value.array() == highest).count() + (recording.value.array() == lowest).count());
  EXPECT_GT(cut.censored, 190);  // the hold
  EXPECT_THAT(cut.noise.high, testing::AllOf(testing::Lt(highest), testing::Gt(highest - kCount)));
  EXPECT_THAT(cut.noise.low, testing::AllOf(testing::Gt(lowest), testing::Lt(lowest + kCount)));
  recording.range = SensorRange{-1, 1};  // no reading comes near
  const FitProblem whole = Must(MakeFitProblem(recording, ModelOptions("coulomb")));
  EXPECT_EQ(whole.censored, 0);
  EXPECT_TRUE(whole.noise.IsUncensoredGaussian());
}

}  // namespace
}  // namespace pendulum::fit_problem_test
