// SPDX-License-Identifier: Apache-2.0
#include "fitting/fit/fit_ending.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/joint_problem.h"
#include "pendulum/fitting/fit/solve_jointly.h"
#include "tests/fitting/fitted.h"
#include "tests/fitting/joint_recordings.h"

namespace pendulum::fit_ending_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Two recordings at the solution of their common fit, with the fits alone.
struct TwoSolved {
  TwoRuns runs;
  JointProblem joint = runs.Problem();
  Solution solution = SolveJointly(joint);
  Optimum optimum = Linearize(joint.solve, *joint.cost, solution).value();
  std::vector<Description> described{2};

  Ending End() {
    const SolvedFit fit = joint.SolvedAt(solution);
    return EndingOf(fit, optimum, described, {&runs.alone[0], &runs.alone[1]});
  }

  /// Makes the trajectory of a recording equal to its readings, so that only its parameters are judged.
  void ExplainAll() {
    for (JointMember& member : joint.members) member.solution.readings = member.recording->value;
  }
};

void ExpectEnding(const Ending& ending, Termination termination, const std::string& reason) {
  EXPECT_EQ(ending.termination, termination);
  EXPECT_EQ(ending.reason, reason);
}

TEST(EndingOf, IsConvergedAtTheMinimumOfSeveral) {
  TwoSolved two;
  ExpectEnding(two.End(), Termination::kConverged, "the estimates are within 0.1 standard errors of the minimum");
}

// If a parameter is one standard error off and the others follow, A p = -gradient is 0 but for that parameter.
TEST(EndingOf, IsNotConvergedAStandardErrorAway) {
  TwoSolved two;
  two.optimum.gradient.setZero();
  two.optimum.gradient[0] = 1 / std::sqrt(two.optimum.inverse.matrix(0, 0));
  const Ending ending = two.End();
  EXPECT_EQ(ending.termination, Termination::kNotConverged);
  EXPECT_EQ(ending.reason,
            "the estimates are still 1 standard errors from the minimum; try a shorter window or another model");
}

TEST(EndingOf, NamesTheRecordingsThatAreNotExplained) {
  TwoSolved two;
  two.joint.members[1].solution.readings.setConstant(two.joint.members[1].recording->value.mean());
  two.optimum.inverse.identifiable = false;  // comes second
  ExpectEnding(
      two.End(), Termination::kNotConverged,
      "these are not swings of one pendulum with one inertia, viscous and coulomb: the best joint trajectories "
      "leave 100 % of the variance of recording 2 unexplained");
}

TEST(EndingOf, NamesTheRecordingOfWhatIsNotDetermined) {
  TwoSolved two;
  two.optimum.inverse.identifiable = false;
  two.optimum.inverse.direction = {1, 3, 8};
  const Ending ending = two.End();
  EXPECT_EQ(ending.termination, Termination::kNotIdentifiable);
  EXPECT_EQ(ending.reason,
            "the recordings together do not determine viscous, release_angle of recording 1 and zero_angle of "
            "recording 2; fix or share more parameters");
}

// The readings lie between -0.6 and 0.6 rad.
TEST(EndingOf, NamesTheRecordingThatIsImplausible) {
  TwoSolved two;
  two.ExplainAll();
  two.joint.members[1].solution.parameters.back() = 2;
  const Ending ending = two.End();
  EXPECT_EQ(ending.termination, Termination::kNotConverged);
  EXPECT_THAT(ending.reason, StartsWith("recording 2: the best trajectory does not describe the readings: the fitted "
                                        "zero_angle of 2 is outside the readings"));
}

// Half a period of the slow pendulum is 2 pi sqrt(100) / 2 = 31 s, longer than both recordings.
TEST(EndingOf, NeedsHalfAPeriodInSomeRecording) {
  TwoSolved two;
  two.ExplainAll();
  two.joint.members[0].solution.parameters[0] = 100;
  EXPECT_EQ(two.End().termination, Termination::kConverged);
  two.joint.members[1].solution.parameters[0] = 100;
  const Ending ending = two.End();
  EXPECT_EQ(ending.termination, Termination::kNotConverged);
  EXPECT_THAT(ending.reason, StartsWith("in every recording the motion lasts only 0.1"));
}

TEST(EndingOf, KeepsTheAmbiguityOfASeparateFit) {
  TwoSolved two;
  two.runs.alone[1].reason = "with radius 0.2 the fit is nearly as good";
  two.runs.alone[1].warnings.push_back({"ambiguous_sensor", two.runs.alone[1].reason});
  ExpectEnding(two.End(), Termination::kNotIdentifiable, "recording 2: with radius 0.2 the fit is nearly as good");
}

TEST(EndingOf, SaysThatNothingWasFitted) {
  TwoSolved two;
  two.optimum.free.clear();
  two.optimum.inverse.matrix.resize(0, 0);
  EXPECT_THAT(two.End().reason, HasSubstr("every parameter is fixed"));
}

TEST(EndingOf, PutsWhatASingleRecordingDoesNotExplainFirst) {
  Fitted fitted = FitWithInternals(Must(SimulateRecording(ShortSwing())), ModelOptions("coulomb"));
  fitted.optimum.inverse.identifiable = false;
  fitted.optimum.inverse.direction = {2};
  const std::vector<Description> described(1);
  const Ending undetermined = EndingOf(SolvedFitOf(fitted.Run()), fitted.optimum, described, {});
  EXPECT_EQ(undetermined.termination, Termination::kNotIdentifiable);
  EXPECT_EQ(undetermined.reason, "the recording does not depend on coulomb; fix it");
  fitted.solution.readings.setConstant(fitted.recording.value.mean());
  const Ending unexplained = EndingOf(SolvedFitOf(fitted.Run()), fitted.optimum, described, {});
  EXPECT_EQ(unexplained.termination, Termination::kNotConverged);
  EXPECT_THAT(unexplained.reason, HasSubstr("this is not a free pendulum's swing, or not one of this model"));
}

}  // namespace
}  // namespace pendulum::fit_ending_test
