// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

namespace {

/// Trajectories after which a search ends where it is: good recordings need tens, hopeless ones would take for ever.
constexpr int kMostEvaluations = 1000;

/// Indices of the parameters that are not held and stand at their lower bound.
std::vector<std::size_t> AtBound(const std::vector<double>& parameters, const SolveOptions& options,
                                 const std::vector<bool>& held) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!held[i] && parameters[i] <= options.lower[i]) indices.push_back(i);
  }
  return indices;
}

/// Ends a solve as soon as a step lands on a bound: Ceres cuts its steps there, and cut steps creep along the bound.
class StopAtBound final : public ceres::IterationCallback {
 public:
  StopAtBound(const std::vector<double>& parameters, const SolveOptions& options, const std::vector<bool>& held)
      : parameters_(parameters), options_(options), held_(held) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const bool landed =
        summary.iteration > 0 && summary.step_is_successful && !AtBound(parameters_, options_, held_).empty();
    return landed ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const std::vector<double>& parameters_;
  const SolveOptions& options_;
  const std::vector<bool>& held_;
};

ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = max_iterations;
  solver.function_tolerance = 1e-10;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  solver.update_state_every_iteration = true;
  // A line search along a cut step would cost a trajectory in every iteration.
  solver.max_num_line_search_step_size_iterations = 0;
  return solver;
}

/// One run of Ceres over the parameters that are not held; ends at convergence or on a bound.
void Run(TrajectoryCost& cost, const SolveOptions& options, const std::vector<bool>& held, Solution& solution) {
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem problem(problem_options);
  std::vector<double*> blocks;
  for (double& parameter : solution.parameters) blocks.push_back(&parameter);
  problem.AddResidualBlock(&cost, nullptr, blocks);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (held[i]) {
      problem.SetParameterBlockConstant(blocks[i]);
    } else if (std::isfinite(options.lower[i])) {
      problem.SetParameterLowerBound(blocks[i], 0, options.lower[i]);
    }
  }
  StopAtBound stop(solution.parameters, options, held);
  ceres::Solver::Options solver = SolverOptions(options.max_iterations);
  solver.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  solution.usable = summary.IsSolutionUsable();
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.sum = 2 * summary.final_cost;
  // Ceres leaves -1 in what it did not come to count.
  solution.iterations += std::max(static_cast<int>(summary.iterations.size()) - 1, 0);
  solution.evaluations += std::max(summary.num_residual_evaluations, 0) + std::max(summary.num_jacobian_evaluations, 0);
  solution.message = summary.message;
}

/// Of the parameters held at their bound, the one the cost pulls inwards most; -1 when there is none.
int PulledInwards(const TrajectoryCost& cost, const SolveOptions& options, const std::vector<bool>& held,
                  const Solution& solution) {
  Eigen::MatrixXd sums;
  if (!cost.Sums(solution.parameters, &sums)) return -1;
  int pulled = -1;
  double strongest = -1e-6 * std::sqrt(solution.sum);  // less is rounding
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    if (!held[i] || options.fixed[i] || !(sums(i, i) > 0)) continue;
    const double slope = sums(i, sums.cols() - 1) / std::sqrt(sums(i, i));
    if (slope >= strongest) continue;
    strongest = slope;
    pulled = i;
  }
  return pulled;
}

}  // namespace

Solution Solve(TrajectoryCost& cost, const std::vector<double>& start, const SolveOptions& options) {
  Solution solution;
  solution.parameters = start;
  std::vector<bool> held = options.fixed;
  const std::size_t most_runs = 4 * start.size();
  for (std::size_t run = 0; run < most_runs; ++run) {
    Run(cost, options, held, solution);
    if (!solution.usable || solution.evaluations > kMostEvaluations) break;
    const std::vector<std::size_t> landed = AtBound(solution.parameters, options, held);
    for (const std::size_t i : landed) held[i] = true;
    if (!landed.empty()) continue;
    if (held == options.fixed) break;
    const int pulled = PulledInwards(cost, options, held, solution);
    if (pulled < 0) break;
    held[pulled] = false;
  }
  return solution;
}

Solution Continue(TrajectoryCost& cost, const Solution& from, const SolveOptions& options) {
  Solution solution = Solve(cost, from.parameters, options);
  if (!solution.usable) solution.parameters = from.parameters;
  solution.iterations += from.iterations;
  solution.evaluations += from.evaluations;
  solution.rivals = from.rivals;
  return solution;
}

namespace {

/// A start explains the data when it leaves less than this share of their variance.
constexpr double kExplained = 0.1;

double Variance(const TrajectoryData& data) {
  const Eigen::Map<const Eigen::VectorXd> value(data.value.data(), static_cast<Eigen::Index>(data.value.size()));
  return (value.array() - value.mean()).square().sum() / (data.scale * data.scale);
}

std::size_t SamplesBefore(const TrajectoryData& data, double time) {
  return static_cast<std::size_t>(std::upper_bound(data.time.begin(), data.time.end(), time) - data.time.begin());
}

/// Solves over the samples before each of the times in turn, each from the last; leaves the cost with all samples.
Solution SolveGrowing(TrajectoryCost& cost, const TrajectoryData& data, Solution solution, const SolveOptions& options,
                      const std::vector<double>& times) {
  constexpr std::size_t kFewest = 16;
  for (const double time : times) {
    const std::size_t count = SamplesBefore(data, time);
    if (count < kFewest || count >= data.time.size() || solution.evaluations > kMostEvaluations) continue;
    cost.set_used_samples(count);
    solution = Continue(cost, solution, options);
  }
  cost.set_used_samples(data.time.size());
  return solution;
}

/// When the motion begins: the hold belongs to no share of it.
double MotionStart(const TrajectoryData& data, const std::vector<double>& parameters) {
  return data.latest_release > 0 ? parameters[parameters.size() - 2] : 0.0;
}

std::vector<double> GrowingTimes(double begin, double end, double cycle) {
  std::vector<double> times;
  if (!(cycle > 0)) return times;
  for (double length = 3 * cycle; begin + length < end; length *= 2) times.push_back(begin + length);
  return times;
}

/// How all parameters move when parameter k does and the others follow to keep the cost low: a column of the inverse of
/// J'J over the free parameters, with a 1 at k; empty where the data do not determine it.
Eigen::VectorXd ProfileDirection(const TrajectoryCost& cost, const std::vector<double>& at, int k,
                                 const SolveOptions& options) {
  Eigen::MatrixXd sums;
  if (!cost.Sums(at, &sums)) return {};
  std::vector<int> free;
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    if (!options.fixed[i] && (i == k || at[i] > options.lower[i])) free.push_back(i);
  }
  const Eigen::Index position = std::find(free.begin(), free.end(), k) - free.begin();
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(free.size()), position);
  const Eigen::VectorXd column = sums(free, free).ldlt().solve(unit);
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(at.size()));
  direction(free) = column / column[position];
  return direction.allFinite() ? direction : Eigen::VectorXd();
}

/// A start on the other side of the next change in the number of reversals: from a minimum along the profile of dry
/// friction, weaker (side -1) or stronger (+1); empty when there is none within 20 %.
std::vector<double> NextBasin(const TrajectoryCost& cost, const std::vector<double>& from, double side,
                              const SolveOptions& options) {
  constexpr double kFirstShift = 1e-3;
  constexpr double kLargestShift = 0.2;
  constexpr double kGrowth = 1.15;
  const int k = options.holding_parameter;
  const Eigen::VectorXd direction = ProfileDirection(cost, from, k, options);
  if (direction.size() == 0) return {};
  const auto shifted = [&](double shift) {
    std::vector<double> start = from;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const double change = shift * from[k] * direction[static_cast<Eigen::Index>(i)];
      start[i] = std::max(start[i] + change, options.lower[i]);
    }
    return start;
  };
  const int reversals = cost.Trace(from).reversals;
  for (double shift = kFirstShift; shift < kLargestShift; shift *= kGrowth) {
    if (cost.Trace(shifted(side * shift)).reversals != reversals) return shifted(side * shift * kGrowth);
  }
  return {};
}

/// Goes on to the neighbouring minima of a recording that reaches rest, on both sides, as long as they are lower.
Solution DescendBasins(TrajectoryCost& cost, const Solution& found, const SolveOptions& options) {
  Solution best = found;
  for (const double side : {-1.0, 1.0}) {
    for (bool better = true; better && best.evaluations < kMostEvaluations;) {
      Solution trial = best;
      trial.parameters = NextBasin(cost, best.parameters, side, options);
      if (trial.parameters.empty()) break;
      trial = Continue(cost, trial, options);
      better = trial.usable && trial.sum < best.sum;
      const Solution& other = better ? best : trial;
      std::vector<Rival> rivals = best.rivals;
      if (other.usable) rivals.push_back({other.parameters, other.sum});
      best.iterations = trial.iterations;
      best.evaluations = trial.evaluations;
      if (better) best = trial;
      best.rivals = rivals;
    }
  }
  return best;
}

bool ReachesRest(const TrajectoryCost& cost, const TrajectoryData& data, const std::vector<double>& parameters) {
  return cost.Trace(parameters).stop_time < data.time.back();
}

}  // namespace

Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const std::vector<double>& start,
                const SolveOptions& options) {
  Solution solution;
  solution.parameters = start;
  const double begin = MotionStart(data, start);
  double sum = 0;
  const bool traced = cost.SumOfSquares(start, &sum);
  const int holding = options.holding_parameter;
  const bool may_rest = traced && holding >= 0 && start[holding] > 0;
  const double stop = may_rest ? std::min(cost.Trace(start).stop_time, data.time.back()) : data.time.back();
  if (!traced || sum > kExplained * Variance(data)) {
    const double cycle = 2 * kPi * std::sqrt(start[0]);
    solution = SolveGrowing(cost, data, solution, options, GrowingTimes(begin, data.time.back(), cycle));
  } else if (stop < data.time.back()) {
    const double motion = stop - begin;
    solution = SolveGrowing(cost, data, solution, options,
                            {begin + 0.3 * motion, begin + 0.6 * motion, begin + 0.85 * motion});
  }
  solution = Continue(cost, solution, options);
  if (!solution.usable || holding < 0 || options.fixed[holding]) return solution;
  if (!ReachesRest(cost, data, solution.parameters)) return solution;
  return DescendBasins(cost, solution, options);
}

}  // namespace pendulum
