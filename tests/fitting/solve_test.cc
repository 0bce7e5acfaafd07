// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/solve_case.h"

namespace pendulum {
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

TEST(Solve, ReportsTheSumOfSquaresItReached) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  EXPECT_THAT(solution.sum, DoubleNear(c.SumAt(solution.parameters), 1e-6));
  // Noise fits better off the truth, by χ² of six parameters: between its quantiles of 0.1 % and 99.9 %.
  EXPECT_THAT(c.SumAt(c.truth) - solution.sum, AllOf(Gt(0.38), Lt(22.5)));
}

TEST(Solve, NoNeighbourIsLowerThanTheMinimum) {
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

TEST(Solve, LeavesFixedParametersAlone) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  std::vector<double> start = c.problem.first_guess;
  start[1] = 0.0021;
  SolveOptions options = c.problem.solve;
  options.fixed[1] = true;
  EXPECT_EQ(Solve(*c.cost, start, options).parameters[1], 0.0021);
}

TEST(Solve, StaysWithinTheBoundsAndBestThere) {
  SolveCase c(NoisyRun("viscous"), "drag");  // there is neither dry friction nor drag in the data
  for (const double start : {0.0, 1e-3}) {
    std::vector<double> guess = c.problem.first_guess;
    guess[2] = guess[3] = start;
    const Solution solution = Solve(*c.cost, guess, c.problem.solve);
    for (const int k : {1, 2, 3}) EXPECT_THAT(solution.parameters[k], Ge(0.0)) << k;
    Eigen::MatrixXd sums;
    ASSERT_TRUE(c.cost->Sums(solution.parameters, &sums));
    for (const int k : {1, 2, 3}) {
      const double gradient = sums(k, 7) / std::sqrt(sums(k, k));  // of half the sum, in standard errors of k alone
      if (solution.parameters[k] > 0) {
        EXPECT_THAT(gradient, DoubleNear(0, 0.01)) << k;
      } else {
        EXPECT_THAT(gradient, Ge(0.0)) << k;  // only outside would it be lower
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

TEST(Solve, HoldsAReleaseThatTheDataWantLaterAtTheEndOfTheHold) {
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
    const double gradient = sums(k, 6) / std::sqrt(sums(k, k));  // of half the sum, in standard errors of k alone
    if (k == 4) {
      EXPECT_THAT(gradient, Lt(-1.0));  // only later would it be lower
    } else {
      EXPECT_THAT(gradient, DoubleNear(0, 0.01)) << k;
    }
  }
}

TEST(Solve, StopsAtTheIterationLimitAndSaysSo) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.max_iterations = 1;
  const Solution solution = Solve(*c.cost, c.problem.first_guess, options);
  EXPECT_TRUE(solution.usable);
  EXPECT_EQ(solution.iterations, 1);
  EXPECT_LT(solution.sum, c.SumAt(c.problem.first_guess));
  EXPECT_THAT(solution.message, HasSubstr("Maximum number of iterations"));
}

TEST(Solve, CountsItsWork) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  EXPECT_THAT(solution.iterations, Ge(2));
  EXPECT_THAT(solution.evaluations, Gt(solution.iterations));
}

TEST(Continue, GoesOnFromWhereASolutionEndedAndAddsTheWork) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.max_iterations = 1;
  Solution first = Solve(*c.cost, c.problem.first_guess, options);
  first.other_minima.push_back({first.parameters, 12.5});
  const Solution second = Continue(*c.cost, first, c.problem.solve);
  EXPECT_LT(second.sum, first.sum);
  EXPECT_THAT(second.iterations, Gt(first.iterations));
  EXPECT_THAT(second.evaluations, Gt(first.evaluations));
  ASSERT_EQ(second.other_minima.size(), 1);
  EXPECT_EQ(second.other_minima[0].sum, 12.5);
}

}  // namespace
}  // namespace pendulum
