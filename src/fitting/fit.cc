// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit.h"

#include <algorithm>
#include <cmath>

#include "pendulum/fitting/fit_problem.h"
#include "pendulum/fitting/judge.h"
#include "pendulum/fitting/search.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

/// The readings at a solution, and their largest difference to those of a hundredth of the tolerance.
bool MeasureAccuracy(TrajectoryCost& cost, double tolerance, Solution& solution) {
  Eigen::VectorXd finer;
  cost.set_tolerance(1e-2 * tolerance);
  const bool finer_traced = cost.Readings(solution.parameters, &finer, nullptr);
  cost.set_tolerance(tolerance);
  if (!cost.Readings(solution.parameters, &solution.readings, nullptr) || !finer_traced) return false;
  solution.trace_error = (solution.readings - finer).cwiseAbs().maxCoeff();
  return true;
}

/// Solves at the tolerance expected to suffice, measures the trajectory's error at the solution, and solves again with
/// a finer one while the error is too large.
Solution SolveToAccuracy(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options) {
  constexpr double kSmallestError = 1e-12;  // rad; rounding over a long recording comes near it
  constexpr int kMostRefinements = 3;
  const double max_error = std::max(std::min(options.max_trace_error, 1e-3 * problem.data.scale), kSmallestError);
  double tolerance = TraceTolerance(max_error, problem.start.amplitude);
  cost.set_tolerance(tolerance);
  Solution solution = Search(cost, problem.data, problem.first_guess, problem.solve);
  for (int refinement = 0; solution.usable; ++refinement) {
    solution.usable = MeasureAccuracy(cost, tolerance, solution);
    if (solution.trace_error <= max_error || refinement == kMostRefinements) break;
    tolerance = std::max(1e-2 * tolerance, 1e-17);
    cost.set_tolerance(tolerance);
    solution = Continue(cost, solution, problem.solve);
  }
  return solution;
}

}  // namespace

std::string_view TerminationName(Termination termination) {
  switch (termination) {
    case Termination::kConverged: return "converged";
    case Termination::kNotConverged: return "not_converged";
    case Termination::kNotIdentifiable: return "not_identifiable";
    case Termination::kFailed: return "failed";
  }
  return "failed";
}

int ExitCode(Termination termination) { return termination == Termination::kConverged ? 0 : 1; }

const ParameterEstimate* FitReport::Find(std::string_view name) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.info.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

Result<FitReport> FitRecording(const Recording& recording, const FitOptions& options) {
  const Result<FitProblem> problem = MakeFitProblem(recording, options);
  if (!problem) return tl::unexpected(problem.error());
  const auto cost = MakeTrajectoryCost(problem->model, problem->start.start, problem->data);
  return Judge(recording, options, *problem, *cost, SolveToAccuracy(*cost, *problem, options));
}

}  // namespace pendulum
