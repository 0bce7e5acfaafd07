// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit.h"

#include <algorithm>
#include <cmath>

#include "pendulum/fitting/fit_problem.h"
#include "pendulum/fitting/judge.h"
#include "pendulum/trajectory/tolerance.h"

namespace pendulum {
namespace {

/// Largest difference of the readings to those of a trajectory of a hundredth of the tolerance.
double TraceError(TrajectoryCost& cost, const std::vector<double>& parameters, double tolerance) {
  Eigen::VectorXd readings, finer;
  cost.set_tolerance(tolerance);
  if (!cost.Readings(parameters, &readings, nullptr)) return kUnbounded;
  cost.set_tolerance(1e-2 * tolerance);
  if (!cost.Readings(parameters, &finer, nullptr)) return kUnbounded;
  cost.set_tolerance(tolerance);
  return (readings - finer).cwiseAbs().maxCoeff();
}

/// Solves at the tolerance expected to suffice, measures the trajectory's error at the solution, and solves again with
/// a finer one while the error is too large.
Solution SolveToAccuracy(TrajectoryCost& cost, const FitProblem& problem, const FitOptions& options,
                         double* trace_error) {
  const double max_error = std::max(std::min(options.max_trace_error, 1e-3 * problem.noise), 1e-12);
  double tolerance = TraceTolerance(max_error, problem.start.amplitude);
  cost.set_tolerance(tolerance);
  Solution solution = Search(cost, problem.data, problem.first_guess, problem.solve);
  *trace_error = TraceError(cost, solution.parameters, tolerance);
  for (int attempt = 0; solution.usable && *trace_error > max_error && attempt < 3; ++attempt) {
    tolerance = std::max(1e-2 * tolerance, 1e-17);
    cost.set_tolerance(tolerance);
    const Solution coarse = solution;
    solution = Solve(cost, coarse.parameters, problem.solve);
    solution.iterations += coarse.iterations;
    solution.evaluations += coarse.evaluations;
    solution.rivals = coarse.rivals;
    *trace_error = TraceError(cost, solution.parameters, tolerance);
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
  double trace_error = 0;
  const Solution solution = SolveToAccuracy(*cost, *problem, options, &trace_error);
  FitReport report = Judge(recording, options, *problem, *cost, solution);
  report.trace_error = trace_error;
  return report;
}

}  // namespace pendulum
