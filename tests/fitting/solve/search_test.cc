// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/search.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/solve_case.h"

namespace pendulum::search_test {
namespace {

using testing::Ge;
using testing::Gt;

/// Dry friction stops the pendulum well before the end.
SyntheticOptions RunToRest() {
  SyntheticOptions run = TextbookRun("coulomb");
  run.parameters[2] *= 3;
  run.duration = 30;
  run.noise = 0.002;
  return run;
}

/// The same start for every law, with fixed parameters at 0.
StartGuess Always(const std::vector<double>& start) {
  return [start](const std::vector<bool>& fixed) {
    std::vector<double> guess = start;
    for (std::size_t i = 0; i < guess.size(); ++i) {
      if (fixed[i]) guess[i] = 0;
    }
    return guess;
  };
}

TEST(Search, ConvergesFromAStartThatIsSeveralCyclesOff) {
  // Five percent of frequency over 40 cycles is two cycles.
  for (const double factor : {0.6, 0.9}) {
    SyntheticOptions run = NoisyRun("coulomb");
    run.duration = 60;
    SolveCase c(run, "coulomb");
    std::vector<double> start = c.problem.first_guess;
    start[0] *= factor;
    start[1] *= 1.2;
    start[2] *= 0.8;
    const Solution expected = Solve(*c.cost, c.truth, c.problem.solve);
    const Solution found = Search(*c.cost, c.problem.data, Always(start), c.problem.solve);
    ExpectNear(found.parameters, expected.parameters, 1e-4);
    EXPECT_GT(Solve(*c.cost, start, c.problem.solve).sum, 2 * expected.sum);  // therefore one Solve is not enough
  }
}

TEST(Search, UsesAllSamplesAtTheEnd) {
  SyntheticOptions run = NoisyRun("coulomb");
  run.duration = 35;
  SolveCase c(run, "coulomb");
  std::vector<double> start = c.problem.first_guess;
  start[0] *= 0.9;
  Search(*c.cost, c.problem.data, Always(start), c.problem.solve);
  Eigen::VectorXd readings;
  ASSERT_TRUE(c.cost->Readings(c.truth, &readings, nullptr));
  EXPECT_EQ(readings.size(), 3500);
}

TEST(Search, TriesNeighbouringNumbersOfHalfSwings) {
  SolveCase c(RunToRest(), "coulomb");
  const Solution solution = Search(*c.cost, c.problem.data, c.Guess(), c.problem.solve);
  ASSERT_LT(c.cost->Trace(solution.parameters).stop_time, 30);
  EXPECT_THAT(solution.other_minima.size(), Gt(0));
  for (const Minimum& other : solution.other_minima) EXPECT_THAT(other.sum, Ge(solution.sum));
  EXPECT_LE(solution.sum, Solve(*c.cost, c.truth, c.problem.solve).sum * (1 + 1e-8));
}

TEST(Search, FindsOneMinimumIfThePendulumDoesNotComeToRest) {
  SolveCase c(NoisyRun("coulomb"), "coulomb");
  EXPECT_TRUE(Search(*c.cost, c.problem.data, c.Guess(), c.problem.solve).other_minima.empty());
}

TEST(Search, IsNeverWorseThanASimplerLaw) {
  // Dry friction of 0.2 G stops the start's motion after one half swing, but the pendulum swings for 60 s.
  SyntheticOptions run = NoisyRun("viscous");
  run.duration = 60;
  SolveCase simple(run, "viscous");
  const Solution expected = Solve(*simple.cost, simple.truth, simple.problem.solve);
  SolveCase rich(run, "drag");
  std::vector<double> start = rich.problem.first_guess;
  start[2] = 0.2;
  start[3] = 0.2;
  EXPECT_LE(Search(*rich.cost, rich.problem.data, Always(start), rich.problem.solve).sum, expected.sum * (1 + 1e-8));
}

TEST(Search, StaysWithinBounds) {
  SolveCase c(RunToRest(), "coulomb");
  SolveOptions options = c.problem.solve;
  options.upper[4] = c.truth[4] - 0.002;
  const Solution found = Search(*c.cost, c.problem.data, c.Guess(), options);
  EXPECT_EQ(found.parameters[4], options.upper[4]);
  EXPECT_THAT(found.other_minima.size(), Gt(0));
  for (const Minimum& other : found.other_minima) {
    EXPECT_LE(other.parameters[4], options.upper[4]);
    EXPECT_GE(other.sum, found.sum);
  }
}

}  // namespace
}  // namespace pendulum::search_test
