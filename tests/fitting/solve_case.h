// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of solver and search: a prepared recording and its cost.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/fitting/solve/fit_problem.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {

/// A simulated recording prepared for the solver, with the cost of the model to be fitted.
struct SolveCase {
  SolveCase(const SyntheticOptions& run, std::string_view model)
      : truth(Truth(run)),
        problem(Must(MakeFitProblem(Must(SimulateRecording(run)), ModelOptions(model)))),
        cost(MakeTrajectoryCost(problem.model, problem.start.start, problem.data)) {
    cost->set_tolerance(1e-13);
  }

  auto Guess() const {
    return [this](const std::vector<bool>& fixed) { return FirstGuess(problem, fixed); };
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

inline void ExpectNear(const std::vector<double>& found, const std::vector<double>& expected, double relative) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], relative * std::abs(expected[i])) << "parameter " << i;
  }
}

}  // namespace pendulum
