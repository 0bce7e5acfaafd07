// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit_problem.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {
namespace {

using testing::DoubleNear;
using testing::Ge;
using testing::Gt;

/// A simulated recording, ready to be solved, with the cost of the model it is solved for.
struct Case {
  Case(const SyntheticOptions& run, std::string_view model)
      : truth(Truth(run)),
        problem(Must(MakeFitProblem(Must(SimulateRecording(run)), ModelOptions(model)))),
        cost(MakeTrajectoryCost(problem.model, problem.start.start, problem.data)) {
    cost->set_tolerance(1e-13);
  }

  double SumAt(const std::vector<double>& parameters) const {
    double sum = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(cost->SumOfSquares(parameters, &sum));
    return sum;
  }

  std::vector<double> truth;
  FitProblem problem;
  std::unique_ptr<TrajectoryCost> cost;
};

void ExpectNear(const std::vector<double>& found, const std::vector<double>& expected, double relative) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], relative * std::abs(expected[i])) << "parameter " << i;
  }
}

/// 10 s of the textbook rig with noise, released at 1.9 s.
SyntheticOptions NoisyRun(std::string_view model) {
  SyntheticOptions run = TextbookRun(model);
  run.duration = 10;
  run.noise = 0.002;
  return run;
}

// ---- Solve ---------------------------------------------------------------------------------------------------------

TEST(Solve, ReturnsToTheTruthFromNearby) {
  SyntheticOptions run = TextbookRun("coulomb");
  Case c(run, "coulomb");
  std::vector<double> start = c.truth;
  for (double& parameter : start) parameter *= 1.003;
  const Solution solution = Solve(*c.cost, start, c.problem.solve);
  EXPECT_TRUE(solution.usable);
  EXPECT_TRUE(solution.converged);
  ExpectNear(solution.parameters, c.truth, 1e-7);
}

TEST(Solve, ReportsTheSumOfSquaresItReached) {
  Case c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  EXPECT_THAT(solution.sum, DoubleNear(c.SumAt(solution.parameters), 1e-6));
  EXPECT_LT(solution.sum, c.SumAt(c.truth));                        // noise fits a little better off the truth
  EXPECT_THAT(c.SumAt(c.truth) - solution.sum, DoubleNear(6, 12));  // χ² of six parameters
}

TEST(Solve, NoNeighbourIsLowerThanTheMinimum) {
  Case c(NoisyRun("coulomb"), "coulomb");
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
  Case c(NoisyRun("coulomb"), "coulomb");
  std::vector<double> start = c.problem.first_guess;
  start[1] = 0.0021;
  SolveOptions options = c.problem.solve;
  options.fixed[1] = true;
  EXPECT_EQ(Solve(*c.cost, start, options).parameters[1], 0.0021);
}

TEST(Solve, StaysWithinTheBoundsAndBestThere) {
  Case c(NoisyRun("viscous"), "drag");  // there is neither dry friction nor drag in the data
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
  Case c(NoisyRun("coulomb"), "coulomb");
  std::vector<double> start = c.truth;
  start[2] = 0.9;  // dry friction holds the pendulum at its release angle
  EXPECT_FALSE(Solve(*c.cost, start, c.problem.solve).usable);
  start = c.truth;
  start[4] = c.problem.data.latest_release + 0.1;
  EXPECT_FALSE(Solve(*c.cost, start, c.problem.solve).usable);
}

TEST(Solve, StopsAtTheIterationLimitAndSaysSo) {
  Case c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.max_iterations = 1;
  const Solution solution = Solve(*c.cost, c.problem.first_guess, options);
  EXPECT_TRUE(solution.usable);
  EXPECT_FALSE(solution.converged);
  EXPECT_EQ(solution.iterations, 1);
  EXPECT_LT(solution.sum, c.SumAt(c.problem.first_guess));
  EXPECT_FALSE(solution.message.empty());
}

TEST(Solve, CountsItsWork) {
  Case c(NoisyRun("coulomb"), "coulomb");
  const Solution solution = Solve(*c.cost, c.problem.first_guess, c.problem.solve);
  EXPECT_THAT(solution.iterations, Ge(2));
  EXPECT_THAT(solution.evaluations, Gt(solution.iterations));
}

TEST(Continue, GoesOnFromWhereASolutionEndedAndAddsTheWork) {
  Case c(NoisyRun("coulomb"), "coulomb");
  SolveOptions options = c.problem.solve;
  options.max_iterations = 1;
  Solution first = Solve(*c.cost, c.problem.first_guess, options);
  first.rivals.push_back({first.parameters, 12.5});
  const Solution second = Continue(*c.cost, first, c.problem.solve);
  EXPECT_TRUE(second.converged);
  EXPECT_LT(second.sum, first.sum);
  EXPECT_THAT(second.iterations, Gt(first.iterations));
  EXPECT_THAT(second.evaluations, Gt(first.evaluations));
  ASSERT_EQ(second.rivals.size(), 1);
  EXPECT_EQ(second.rivals[0].sum, 12.5);
}

// ---- Search --------------------------------------------------------------------------------------------------------

TEST(Search, FindsTheTruthFromAStartThatIsCyclesOffAtTheEnd) {
  // Five percent of frequency over 25 cycles is more than a cycle; there is a false minimum for every cycle.
  for (const double factor : {0.85, 0.9}) {
    SyntheticOptions run = NoisyRun("coulomb");
    run.duration = 35;
    Case c(run, "coulomb");
    std::vector<double> start = c.problem.first_guess;
    start[0] *= factor;
    start[1] *= 1.2;
    start[2] *= 0.8;
    const Solution expected = Solve(*c.cost, c.truth, c.problem.solve);
    const Solution found = Search(*c.cost, c.problem.data, start, c.problem.solve);
    ExpectNear(found.parameters, expected.parameters, 1e-4);
    EXPECT_GT(Solve(*c.cost, start, c.problem.solve).sum, 100 * expected.sum);  // which is why one Solve is not enough
  }
}

TEST(Search, LeavesAllSamplesInUse) {
  SyntheticOptions run = NoisyRun("coulomb");
  run.duration = 35;
  Case c(run, "coulomb");
  std::vector<double> start = c.problem.first_guess;
  start[0] *= 0.9;
  Search(*c.cost, c.problem.data, start, c.problem.solve);
  Eigen::VectorXd readings;
  ASSERT_TRUE(c.cost->Readings(c.truth, &readings, nullptr));
  EXPECT_EQ(readings.size(), 3500);
}

TEST(Search, TriesTheNeighbouringNumbersOfHalfSwingsOfARecordingThatReachesRest) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.parameters[2] *= 3;
  run.duration = 30;
  run.noise = 0.002;
  Case c(run, "coulomb");
  const Solution solution = Search(*c.cost, c.problem.data, c.problem.first_guess, c.problem.solve);
  ASSERT_LT(c.cost->Trace(solution.parameters).stop_time, 30);
  EXPECT_THAT(solution.rivals.size(), Gt(0));
  for (const Rival& rival : solution.rivals) EXPECT_THAT(rival.sum, Ge(solution.sum));
  EXPECT_LE(solution.sum, Solve(*c.cost, c.truth, c.problem.solve).sum * (1 + 1e-8));
}

TEST(Search, HasNoRivalsWhereNothingComesToRest) {
  Case c(NoisyRun("coulomb"), "coulomb");
  EXPECT_TRUE(Search(*c.cost, c.problem.data, c.problem.first_guess, c.problem.solve).rivals.empty());
}

}  // namespace
}  // namespace pendulum
