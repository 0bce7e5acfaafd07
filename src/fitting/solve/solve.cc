// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/solve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "pendulum/fitting/solve/covariance.h"

namespace pendulum {
namespace {

/// A solve ends when a step changes the cost by a share smaller than this.
constexpr double kSameCost = 1e-10;

/// Indices of the parameters that are not held and lie at a bound.
std::vector<std::size_t> AtBound(const std::vector<double>& parameters, const SolveOptions& options,
                                 const std::vector<bool>& held) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!held[i] && BoundSide(options, i, parameters[i]) != 0) indices.push_back(i);
  }
  return indices;
}

/// The Gauss-Newton step over the parameters that are not held.
struct NewtonStep {
  std::vector<int> free;
  Eigen::VectorXd step;  // empty if the data do not determine all parameters
  bool is_last = false;  // it reduces |r|² by a negligible share
};

NewtonStep StepFrom(const LeastSquares& cost, const std::vector<bool>& held, const std::vector<double>& parameters) {
  Eigen::MatrixXd sums;
  if (!cost.Sums(parameters, &sums)) return {};
  const Eigen::Index size = sums.rows() - 1;
  NewtonStep newton;
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (!held[i]) newton.free.push_back(i);
  }
  const InformationInverse inverse = InvertInformation(sums.topLeftCorner(size, size), newton.free);
  if (!inverse.identifiable) return {};
  const Eigen::VectorXd gradient = sums.col(size)(newton.free);
  newton.step = -inverse.matrix * gradient;
  newton.is_last = -gradient.dot(newton.step) <= kSameCost * sums(size, size);
  return newton;
}

/// Ends a solve as soon as a step reaches a bound. Ceres shortens its steps there, and shortened steps move slowly
/// along the bound. Also ends a solve as soon as the next step would be negligible. That follows from the sums that
/// Ceres just asked for; Ceres itself would need one more trajectory to find out.
class EarlyStop final : public ceres::IterationCallback {
 public:
  EarlyStop(const LeastSquares& cost, const std::vector<double>& parameters, const SolveOptions& options,
            const std::vector<bool>& held)
      : cost_(cost), parameters_(parameters), options_(options), held_(held) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (cost_.is_stopped()) return ceres::SOLVER_ABORT;
    const bool begins = summary.iteration == 0;
    if (!begins && !summary.step_is_successful) return ceres::SOLVER_CONTINUE;
    const bool at_bound = !AtBound(parameters_, options_, held_).empty();
    const bool done = at_bound ? !begins : HasConverged();
    return done ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  bool HasConverged() const { return StepFrom(cost_, held_, parameters_).is_last; }

  const LeastSquares& cost_;
  const std::vector<double>& parameters_;
  const SolveOptions& options_;
  const std::vector<bool>& held_;
};

ceres::Solver::Options SolverOptions(int max_iterations, bool several) {
  ceres::Solver::Options solver;
  // In a joint fit each recording depends on few of the parameters.
  solver.linear_solver_type = several ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
  solver.max_num_iterations = max_iterations;
  // Start values of a recording are good, so the first step is not damped. Damping would leave it 1 % short if two
  // parameters have nearly the same effect.
  if (!several) solver.initial_trust_region_radius = 1e6;
  solver.function_tolerance = kSameCost;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  solver.update_state_every_iteration = true;
  // A line search along a shortened step would need one trajectory per iteration.
  solver.max_num_line_search_step_size_iterations = 0;
  return solver;
}

/// One run of Ceres over the parameters that are not held. Ends at convergence or at a bound.
void RunSolver(LeastSquares& cost, const SolveOptions& options, const std::vector<bool>& held, Solution& solution) {
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem problem(problem_options);
  std::vector<double*> blocks;
  for (double& parameter : solution.parameters) blocks.push_back(&parameter);
  cost.AddTo(problem, blocks);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (held[i]) {
      problem.SetParameterBlockConstant(blocks[i]);
      continue;
    }
    if (std::isfinite(options.lower[i])) problem.SetParameterLowerBound(blocks[i], 0, options.lower[i]);
    if (std::isfinite(options.upper[i])) problem.SetParameterUpperBound(blocks[i], 0, options.upper[i]);
  }
  EarlyStop stop(cost, solution.parameters, options, held);
  ceres::Solver::Options solver = SolverOptions(options.max_iterations, cost.runs() > 1);
  solver.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  solution.usable = summary.IsSolutionUsable();
  solution.sum = 2 * summary.final_cost;
  solution.iterations += std::max(static_cast<int>(summary.iterations.size()) - 1, 0);
  solution.message = summary.message;
}

/// Parameters that the next Gauss-Newton step would move to a bound, each with that bound. Ceres does not make very
/// small steps, so it leaves such parameters just short of their bound.
std::vector<std::pair<std::size_t, double>> ParametersReachingBound(const LeastSquares& cost,
                                                                    const SolveOptions& options,
                                                                    const std::vector<bool>& held,
                                                                    const Solution& solution) {
  const NewtonStep newton = StepFrom(cost, held, solution.parameters);
  std::vector<std::pair<std::size_t, double>> reaching;
  for (Eigen::Index k = 0; k < newton.step.size(); ++k) {
    const auto i = static_cast<std::size_t>(newton.free[static_cast<std::size_t>(k)]);
    const int side = BoundSide(options, i, solution.parameters[i] + newton.step[k]);
    if (side != 0) reaching.emplace_back(i, side < 0 ? options.lower[i] : options.upper[i]);
  }
  return reaching;
}

/// Among the parameters held at their bound, the one that the cost pulls inwards most; -1 if there is none.
int ParameterLeavingBound(const LeastSquares& cost, const SolveOptions& options, const std::vector<bool>& held,
                          const Solution& solution) {
  Eigen::MatrixXd sums;
  if (!cost.Sums(solution.parameters, &sums)) return -1;
  int pulled = -1;
  double strongest = -NegligibleSlope(sums);
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    if (!held[i] || options.fixed[i] || !(sums(i, i) > 0)) continue;
    const int side = BoundSide(options, static_cast<std::size_t>(i), solution.parameters[i]);
    const double slope = -side * sums(i, sums.cols() - 1) / std::sqrt(sums(i, i));
    if (slope >= strongest) continue;
    strongest = slope;
    pulled = i;
  }
  return pulled;
}

}  // namespace

double NegligibleSlope(const Eigen::MatrixXd& sums) {
  return std::sqrt(kSameCost * sums(sums.rows() - 1, sums.cols() - 1));
}

int BoundSide(const SolveOptions& options, std::size_t i, double value) {
  if (value <= options.lower[i]) return -1;
  return value >= options.upper[i] ? 1 : 0;
}

/// An active-set method. A parameter whose step reaches its bound, or would reach it, is held there. It is freed if the
/// cost pulls it inwards at the optimum of the other parameters.
Solution Solve(LeastSquares& cost, const std::vector<double>& start, const SolveOptions& options) {
  Solution solution;
  solution.parameters = start;
  std::vector<bool> held = options.fixed;
  // A parameter is held and freed once or twice. If this repeats, it differs from its bound only by rounding.
  const std::size_t most_runs = 4 * start.size();
  for (std::size_t run = 0; run < most_runs && !cost.is_stopped(); ++run) {
    RunSolver(cost, options, held, solution);
    if (!solution.usable || cost.traces() >= options.max_traces) break;
    const std::vector<std::size_t> at_bound = AtBound(solution.parameters, options, held);
    for (const std::size_t i : at_bound) held[i] = true;
    if (!at_bound.empty()) continue;
    const auto reaching = ParametersReachingBound(cost, options, held, solution);
    for (const auto& [i, bound] : reaching) {
      solution.parameters[i] = bound;
      held[i] = true;
    }
    if (!reaching.empty()) continue;
    if (held == options.fixed) break;
    const int pulled = ParameterLeavingBound(cost, options, held, solution);
    if (pulled < 0) break;
    held[pulled] = false;
  }
  if (cost.is_stopped()) solution.usable = false;
  return solution;
}

Solution Continue(LeastSquares& cost, const Solution& from, const SolveOptions& options) {
  Solution solution = Solve(cost, from.parameters, options);
  if (!solution.usable) solution.parameters = from.parameters;
  solution.iterations += from.iterations;
  solution.other_minima = from.other_minima;
  solution.noise = from.noise;
  solution.noise_reason = from.noise_reason;
  solution.log_likelihood = from.log_likelihood;
  return solution;
}

}  // namespace pendulum
