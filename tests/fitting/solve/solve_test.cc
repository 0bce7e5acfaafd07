// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/solve.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/solve_case.h"

namespace pendulum::solve_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::Gt;
using testing::HasSubstr;
using testing::Lt;

TEST(Solve, ReturnsToTheTruthFromNearby) {
  SyntheticOptions run = TextbookRun("coulomb");
  SolveCase c(run, "coulomb");
  std::vector<double> start = c.truth;
  for (double& parameter : start) parameter *= 1.003;
  const Solution solution = Solve(*c.cost, start, c.problem.solve);
  EXPECT_TRUE(solution.usable);
  ExpectNear(solution.parameters, c.truth, 1e-7);
}

TEST(Solve, ReportsTheReachedSumOfSquares) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  EXPECT_THAT(solution.sum, DoubleNear(c.SumAt(solution.parameters), 1e-6));
  // The sum at the minimum is below the sum at the true parameters by a χ² variable with six degrees of freedom, whose
  // quantiles of 0.1 % and 99.9 % these are.
  EXPECT_THAT(c.SumAt(c.truth) - solution.sum, AllOf(Gt(0.38), Lt(22.5)));
}

TEST(Solve, EndsAtALocalMinimum) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  for (std::size_t i = 0; i < solution.parameters.size(); ++i) {
    for (const double factor : {1 - 1e-3, 1 + 1e-3}) {
      std::vector<double> neighbour = solution.parameters;
      neighbour[i] *= factor;
      EXPECT_THAT(c.SumAt(neighbour), Gt(solution.sum)) << i << " times " << factor;
    }
  }
}

TEST(Solve, KeepsFixedParameters) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  std::vector<double> start = c.problem.first_guess;
  start[1] = 0.0021;
  SolveOptions options = c.problem.solve;
  options.fixed[1] = true;
  EXPECT_EQ(Solve(*c.cost, start, options).parameters[1], 0.0021);
}

TEST(Solve, StaysWithinTheBoundsAndFindsTheMinimumThere) {
  SolveCase c(NoisyRun("viscous"), "drag");  // the data contain neither dry friction nor drag
  for (const double start : {0.0, 1e-3}) {
    std::vector<double> guess = c.problem.first_guess;
    guess[2] = guess[3] = start;
    const Solution solution = Solve(*c.cost, guess, c.problem.solve);
    for (const int k : {1, 2, 3}) EXPECT_THAT(solution.parameters[k], Ge(0.0)) << k;
    Eigen::MatrixXd sums;
    ASSERT_TRUE(c.cost->Sums(solution.parameters, &sums));
    for (const int k : {1, 2, 3}) {
      const double gradient = sums(k, 7) / std::sqrt(sums(k, k));  // of half the sum, per standard error of k alone
      if (solution.parameters[k] > 0) {
        EXPECT_THAT(gradient, DoubleNear(0, 0.01)) << k;
      } else {
        EXPECT_THAT(gradient, Ge(0.0)) << k;  // the sum would be lower only outside the bound
      }
    }
  }
}

TEST(Solve, IsNotUsableFromAStartThatCannotBeTraced) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  std::vector<double> start = c.truth;
  start[2] = 0.9;  // dry friction holds the pendulum at its release angle
  EXPECT_FALSE(Solve(*c.cost, start, c.problem.solve).usable);
}

TEST(Solve, HoldsALateReleaseAtTheEndOfTheHold) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.upper[4] = c.truth[4] - 0.002;
  std::vector<double> start = c.problem.first_guess;
  start[4] = options.upper[4] - 0.01;
  const Solution solution = Solve(*c.cost, start, options);
  EXPECT_EQ(solution.parameters[4], options.upper[4]);
  Eigen::MatrixXd sums;
  ASSERT_TRUE(c.cost->Sums(solution.parameters, &sums));
  for (const int k : {0, 1, 2, 3, 4, 5}) {
    const double gradient = sums(k, 6) / std::sqrt(sums(k, k));  // of half the sum, per standard error of k alone
    if (k == 4) {
      EXPECT_THAT(gradient, Lt(-1.0));  // a later release would lower the sum
    } else {
      EXPECT_THAT(gradient, DoubleNear(0, 0.01)) << k;
    }
  }
}

TEST(Solve, StopsAndReportsTheIterationLimit) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.max_iterations = 1;
  const Solution solution = Solve(*c.cost, c.problem.first_guess, options);
  EXPECT_TRUE(solution.usable);
  EXPECT_EQ(solution.iterations, 1);
  EXPECT_LT(solution.sum, c.SumAt(c.problem.first_guess));
  EXPECT_THAT(solution.message, HasSubstr("Maximum number of iterations"));
}

/// Length of the remaining Gauss-Newton step, in standard errors.
double StepLeft(const SolveCase& c, const std::vector<double>& parameters) {
  Eigen::MatrixXd sums;
  EXPECT_TRUE(c.cost->Sums(parameters, &sums));
  const Eigen::Index size = sums.rows() - 1;
  const Eigen::VectorXd gradient = sums.col(size).head(size);
  const double drop = gradient.dot(sums.topLeftCorner(size, size).ldlt().solve(gradient));
  const double variance = sums(size, size) / static_cast<double>(c.problem.data.time.size());
  return std::sqrt(drop / variance);
}

TEST(Solve, StopsWithinAFractionOfAStandardError) {
  for (const double duration : {10.0, 40.0, 640.0}) {
    SyntheticOptions run = NoisyRun("viscous");
    run.duration = duration;
    SolveCase c(run, "viscous");
    const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
    EXPECT_LE(StepLeft(c, solution.parameters), std::sqrt(1e-10 * 100 * duration)) << duration;
    EXPECT_GT(StepLeft(c, c.problem.first_guess), 1) << duration;
  }
}

TEST(Solve, StartsNoRunBeyondTheBudgetOfTraces) {
  SolveCase c(NoisyRun("viscous"), "drag");
  SolveOptions options = c.problem.solve;
  options.max_traces = 1;
  std::vector<double> guess = c.problem.first_guess;
  guess[2] = guess[3] = 1e-3;
  Solve(*c.cost, guess, options);
  const int one_run = c.cost->traces();
  Solve(*c.cost, guess, c.problem.solve);
  EXPECT_GT(c.cost->traces() - one_run, one_run);  // reaching bounds takes more than one run
}

TEST(Solve, CountsItsWork) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  EXPECT_THAT(solution.iterations, Ge(2));
  EXPECT_THAT(c.cost->traces(), Gt(solution.iterations));
}

TEST(Continue, ContinuesASolutionAndAddsTheWork) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.max_iterations = 1;
  Solution first = Solve(*c.cost, c.problem.first_guess, options);
  first.other_minima.push_back({first.parameters, 12.5});
  const Solution second = Continue(*c.cost, first, c.problem.solve);
  EXPECT_LT(second.sum, first.sum);
  EXPECT_THAT(second.iterations, Gt(first.iterations));
  ASSERT_EQ(second.other_minima.size(), 1);
  EXPECT_EQ(second.other_minima[0].sum, 12.5);
}

}  // namespace
}  // namespace pendulum::solve_test
