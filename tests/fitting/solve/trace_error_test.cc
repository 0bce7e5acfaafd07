// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/trace_error.h"

#include <memory>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::trace_error_test {
namespace {

double MaxErrorOf(double scale, double asked) {
  FitProblem problem;
  problem.data.scale = scale;
  FitOptions options;
  options.search.max_trace_error = asked;
  return MaxTraceError(problem, options);
}

TEST(MaxTraceError, IsTheRequestedErrorOrAThousandthOfTheNoise) {
  EXPECT_DOUBLE_EQ(MaxErrorOf(0.002, 1e-8), 1e-8);
  EXPECT_DOUBLE_EQ(MaxErrorOf(2e-6, 1e-8), 2e-9);
}

TEST(MaxTraceError, IsAtLeastRounding) {
  EXPECT_DOUBLE_EQ(MaxErrorOf(1e-15, 1e-8), 1e-12);
  EXPECT_DOUBLE_EQ(MaxErrorOf(1, 1e-20), 1e-12);
}

TEST(FinerTolerance, IsAHundredthUntilRoundingDominates) {
  EXPECT_DOUBLE_EQ(FinerTolerance(1e-8), 1e-10);
  EXPECT_DOUBLE_EQ(FinerTolerance(1e-16), 1e-17);
  EXPECT_DOUBLE_EQ(FinerTolerance(1e-17), 1e-17);
}

/// A noise-free recording within 1e-12 rad of the truth (synthetic.h), with a cost and a solution at that truth.
struct Traced {
  SyntheticOptions run = TextbookRun("coulomb");
  Recording recording = Must(SimulateRecording(run));
  FitProblem problem = Must(MakeFitProblem(recording, ModelOptions("coulomb")));
  std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  Solution solution;

  Traced() { solution.parameters = Truth(run); }

  bool Measure(double tolerance) { return MeasureTraceError(*cost, tolerance, solution); }

  double TrueError() const { return (solution.readings - recording.value).cwiseAbs().maxCoeff(); }
};

TEST(MeasureTraceError, MatchesTheDistanceFromTheTruth) {
  Traced traced;
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    ASSERT_TRUE(traced.Measure(tolerance));
    EXPECT_GT(traced.TrueError(), 1e-11) << tolerance;  // far above the recording's own error
    // The finer trajectory has an error too, of some hundredths.
    EXPECT_NEAR(traced.solution.trace_error, traced.TrueError(), 0.2 * traced.TrueError()) << tolerance;
  }
}

TEST(MeasureTraceError, IsSmallerAtTheFinerTolerance) {
  Traced traced;
  ASSERT_TRUE(traced.Measure(1e-6));
  const double coarse = traced.solution.trace_error;
  ASSERT_TRUE(traced.Measure(FinerTolerance(1e-6)));
  EXPECT_LT(traced.solution.trace_error, 0.1 * coarse);
}

TEST(MeasureTraceError, ChangesNeitherTheToleranceNorTheReadings) {
  Traced traced;
  ASSERT_TRUE(traced.Measure(1e-6));
  Eigen::VectorXd readings;
  ASSERT_TRUE(traced.cost->Readings(traced.solution.parameters, &readings, nullptr));
  EXPECT_EQ(readings, traced.solution.readings);
}

TEST(MeasureTraceError, FailsIfFrictionHoldsThePendulum) {
  Traced traced;
  traced.solution.parameters[2] = 1;  // coulomb in units of the restoring torque G: more than gravity at any angle
  EXPECT_FALSE(MeasureTraceError(*traced.cost, 1e-8, traced.solution));
}

}  // namespace
}  // namespace pendulum::trace_error_test
