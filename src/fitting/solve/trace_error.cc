// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/trace_error.h"

#include <algorithm>

namespace pendulum {

double MaxTraceError(const FitProblem& problem, const FitOptions& options) {
  constexpr double kSmallestError = 1e-12;  // rad; near the rounding error of a long recording
  return std::max(std::min(options.search.max_trace_error, 1e-3 * problem.data.scale), kSmallestError);
}

bool MeasureTraceError(TrajectoryCost& cost, double tolerance, Solution& solution) {
  Eigen::VectorXd finer;
  cost.set_tolerance(1e-2 * tolerance);
  const bool finer_traced = cost.Readings(solution.parameters, &finer, nullptr);
  cost.set_tolerance(tolerance);
  if (!cost.Readings(solution.parameters, &solution.readings, nullptr) || !finer_traced) return false;
  solution.trace_error = (solution.readings - finer).cwiseAbs().maxCoeff();
  return true;
}

double FinerTolerance(double tolerance) { return std::max(1e-2 * tolerance, 1e-17); }

}  // namespace pendulum
