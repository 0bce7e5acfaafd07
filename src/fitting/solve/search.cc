// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/base/distributions.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {
namespace {

/// A solution explains the data if it leaves less than this share of their variance unexplained.
constexpr double kExplained = 0.1;

double Variance(const TrajectoryData& data) {
  const auto value = data.values();
  return (value.array() - value.mean()).square().sum() / (data.scale * data.scale);
}

std::size_t SamplesBefore(const TrajectoryData& data, double time) {
  return static_cast<std::size_t>(std::upper_bound(data.time.begin(), data.time.end(), time) - data.time.begin());
}

/// Solves over the samples before each of the times in turn, each from the previous solution. Afterwards the cost uses
/// all samples again.
Solution SolveOnGrowingPart(TrajectoryCost& cost, const TrajectoryData& data, Solution solution, SolveOptions options,
                            const std::vector<double>& times) {
  for (const int k : options.small_swing_parameters) options.fixed[k] = true;
  constexpr std::size_t kMinSamples = 16;
  for (const double time : times) {
    const std::size_t count = SamplesBefore(data, time);
    if (count < kMinSamples || count >= data.time.size() || cost.traces() >= options.max_traces) continue;
    cost.set_used_samples(count);
    solution = Continue(cost, solution, options);
  }
  cost.set_used_samples(data.time.size());
  return solution;
}

/// Start of the motion [s]. Shares of the motion are counted from there, without the hold.
double MotionStart(const std::vector<double>& parameters, const SolveOptions& options) {
  return options.release_time >= 0 ? parameters[options.release_time] : 0.0;
}

std::vector<double> GrowingPartEnds(double begin, double end, double cycle) {
  std::vector<double> times;
  if (!(cycle > 0)) return times;
  for (double length = 3 * cycle; begin + length < end; length *= 2) times.push_back(begin + length);
  return times;
}

/// Change of all parameters if parameter k changes by 1 and the other parameters minimize the cost again. It is a
/// column of the inverse of J'J over the free parameters, scaled to 1 at k. Empty if the data do not determine it.
Eigen::VectorXd ProfileDirection(const LeastSquares& cost, const std::vector<double>& at, int k,
                                 const SolveOptions& options) {
  Eigen::MatrixXd sums;
  if (!cost.Sums(at, &sums)) return {};
  std::vector<int> free;
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const bool at_bound = BoundSide(options, static_cast<std::size_t>(i), at[i]) != 0;
    if (!options.fixed[i] && (i == k || !at_bound)) free.push_back(i);
  }
  const Eigen::Index position = std::find(free.begin(), free.end(), k) - free.begin();
  const Eigen::VectorXd unit = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(free.size()), position);
  const Eigen::VectorXd column = sums(free, free).ldlt().solve(unit);
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(at.size()));
  direction(free) = column / column[position];
  return direction.allFinite() ? direction : Eigen::VectorXd();
}

/// `from` shifted by `shift` times a direction, within the bounds.
std::vector<double> ShiftedAlong(const Eigen::VectorXd& direction, double shift, std::vector<double> from,
                                 const SolveOptions& options) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double moved = from[i] + shift * direction[static_cast<Eigen::Index>(i)];
    from[i] = options.fixed[i] ? from[i] : std::clamp(moved, options.lower[i], options.upper[i]);
  }
  return from;
}

/// A start beyond the next change in the number of reversals, on the weaker (side -1) or stronger (+1) side of a local
/// minimum. It lies along the profile of dry friction; or, because long rests may tie that to the number of reversals,
/// where dry friction alone differs. Empty if there is none within 20 %.
std::vector<double> NextLocalMinimumStart(const LeastSquares& cost, const std::vector<double>& from, double side,
                                          const SolveOptions& options) {
  constexpr double kFirstShift = 1e-3;
  constexpr double kLargestShift = 0.2;
  constexpr double kGrowth = 1.15;
  const int k = options.holding_parameter;
  const int reversals = cost.Reversals(from);
  const Eigen::VectorXd alone = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(from.size()), k);
  for (const Eigen::VectorXd& direction : {ProfileDirection(cost, from, k, options), alone}) {
    if (direction.size() == 0) continue;
    const auto shifted = [&](double shift) { return ShiftedAlong(direction, shift * from[k], from, options); };
    for (double shift = kFirstShift; shift < kLargestShift; shift *= kGrowth) {
      if (cost.Reversals(shifted(side * shift)) != reversals) return shifted(side * shift * kGrowth);
    }
  }
  return {};
}

/// Continues to the neighbouring local minima of a recording that reaches rest, on both sides, while they are lower.
Solution DescendToLowerMinima(LeastSquares& cost, const Solution& found, const SolveOptions& options) {
  Solution best = found;
  // A search for all parameters at once may return to the minimum that it comes from.
  SolveOptions held = options;
  held.fixed[options.holding_parameter] = true;
  for (const double side : {-1.0, 1.0}) {
    for (bool better = true; better && cost.traces() < options.max_traces;) {
      Solution trial = best;
      trial.parameters = NextLocalMinimumStart(cost, best.parameters, side, options);
      if (trial.parameters.empty()) break;
      trial = Continue(cost, Continue(cost, trial, held), options);
      if (!trial.usable) break;
      better = trial.sum < best.sum;
      std::vector<Minimum> others = std::move(best.other_minima);
      const Solution& other = better ? best : trial;
      others.push_back({other.parameters, other.sum});
      if (better) best = trial;
      best.iterations = trial.iterations;
      best.other_minima = std::move(others);
    }
  }
  return best;
}

/// Whether the pendulum comes to rest at a local minimum, or with dry friction 1.2 % to either side along its profile.
/// Only then are there other local minima nearby.
bool MayReachRest(const LeastSquares& cost, const std::vector<double>& parameters, const SolveOptions& options) {
  constexpr double kShift = 0.012;
  const int k = options.holding_parameter;
  if (k < 0 || !cost.ComesToRest(parameters, kShift * parameters[k])) return false;
  if (cost.ComesToRest(parameters, 0)) return true;
  if (options.fixed[k] || !(parameters[k] > 0)) return false;
  const Eigen::VectorXd direction = ProfileDirection(cost, parameters, k, options);
  if (direction.size() == 0) return false;
  return cost.ComesToRest(ShiftedAlong(direction, kShift * parameters[k], parameters, options), 0) ||
         cost.ComesToRest(ShiftedAlong(direction, -kShift * parameters[k], parameters, options), 0);
}

/// Solves from `start`. If `start` does not explain the data, first solves over three cycles, then over twice as many,
/// and so on. A recording that reaches rest has one local minimum for each number of half swings before the stop. It is
/// fitted over 30, 60 and 85 percent of the motion first.
Solution SearchFrom(TrajectoryCost& cost, const TrajectoryData& data, const std::vector<double>& start,
                    const SolveOptions& options) {
  Solution solution;
  solution.parameters = start;
  const double begin = MotionStart(start, options);
  // Computes all sums, because Solve asks for them next.
  Eigen::MatrixXd sums;
  const bool traced = cost.Sums(start, &sums);
  const int holding = options.holding_parameter;
  const bool may_rest = traced && holding >= 0 && start[holding] > 0;
  const double stop = may_rest ? std::min(cost.Trace(start).stop_time, data.time.back()) : data.time.back();
  if (!traced || sums(sums.rows() - 1, sums.cols() - 1) > kExplained * Variance(data)) {
    const double cycle = 2 * kPi * std::sqrt(start[0]);
    solution = SolveOnGrowingPart(cost, data, solution, options, GrowingPartEnds(begin, data.time.back(), cycle));
  } else if (stop < data.time.back()) {
    const double motion = stop - begin;
    solution = SolveOnGrowingPart(cost, data, solution, options,
                                  {begin + 0.3 * motion, begin + 0.6 * motion, begin + 0.85 * motion});
  }
  return Refine(cost, solution, options);
}

/// Limits the number of trajectories in one stage of the search, so that the later stages can compute some too.
SolveOptions WithBudget(const TrajectoryCost& cost, SolveOptions options) {
  constexpr int kMaxTraces = 500;
  options.max_traces = std::min(options.max_traces, cost.traces() + kMaxTraces);
  return options;
}

/// Friction parameters that can be fixed at their bound to give a simpler law.
std::vector<int> RemovableFriction(const SolveOptions& options) {
  std::vector<int> removable_friction;
  for (int k = 1; k <= options.last_friction; ++k) {
    const bool needs_small_swings =
        std::ranges::find(options.small_swing_parameters, k) != options.small_swing_parameters.end();
    if (!options.fixed[k] && options.lower[k] == 0 && !needs_small_swings) removable_friction.push_back(k);
  }
  return removable_friction.size() > 1 ? removable_friction : std::vector<int>{};
}

/// Solves with friction parameter k fixed, then continues with it free.
Solution SolveWithout(TrajectoryCost& cost, const TrajectoryData& data, const StartGuess& guess, int k,
                      const SolveOptions& options) {
  SolveOptions simpler = options;
  simpler.fixed[k] = true;
  const bool search = k == RemovableFriction(options).back();
  Solution solution = search ? Search(cost, data, guess, simpler) : Solve(cost, guess(simpler.fixed), simpler);
  solution.other_minima.clear();  // they belong to the simpler law
  return Continue(cost, solution, options);
}

/// Whether the solution explains the data: its deviance is at most a tenth of the deviance of a constant.
bool ExplainsData(const TrajectoryData& data, const Solution& solution) {
  return solution.usable && solution.sum <= kExplained * Variance(data);
}

/// Whether the data determine all free parameters at a solution.
bool IsDetermined(const LeastSquares& cost, const Solution& solution, const SolveOptions& options) {
  const std::optional<Optimum> optimum = Linearize(options, cost, solution);
  return optimum && optimum->inverse.identifiable;
}

/// Whether a solution is the better of two. If the data do not prefer one significantly, it is the one at which they
/// determine all parameters: noise is often fitted a little better by friction that acts at rest alone.
bool IsBetter(const TrajectoryCost& cost, const TrajectoryData& data, const Solution& one, const Solution& than,
              const SolveOptions& options) {
  const double significant = ChiSquareQuantile(0.95, 1);  // of the deviance, with the likeliest σ of each
  if (!one.usable || !than.usable) return one.usable;
  const double gain = static_cast<double>(data.time.size()) * std::log(than.sum / one.sum);
  if (!(std::abs(gain) < significant)) return one.sum < than.sum;
  const bool is_determined = IsDetermined(cost, one, options);
  return is_determined == IsDetermined(cost, than, options) ? one.sum < than.sum : is_determined;
}

}  // namespace

Solution Refine(LeastSquares& cost, const Solution& from, const SolveOptions& options) {
  Solution solution = Continue(cost, from, options);
  const int holding = options.holding_parameter;
  if (!solution.usable || holding < 0 || options.fixed[holding]) return solution;
  if (!MayReachRest(cost, solution.parameters, options)) return solution;
  return DescendToLowerMinima(cost, solution, options);
}

Solution Search(TrajectoryCost& cost, const TrajectoryData& data, const StartGuess& guess,
                const SolveOptions& options) {
  Solution best = SearchFrom(cost, data, guess(options.fixed), WithBudget(cost, options));
  if (ExplainsData(data, best) && !MayReachRest(cost, best.parameters, options)) return best;
  for (const int k : RemovableFriction(options)) {
    Solution other = SolveWithout(cost, data, guess, k, WithBudget(cost, options));
    const bool better = IsBetter(cost, data, other, best, options);
    std::vector<Minimum> others = std::move(best.other_minima);
    if (better) std::swap(best, other);
    if (other.usable && other.sum >= best.sum) others.push_back({other.parameters, other.sum});
    best.other_minima = std::move(others);
    best.iterations += other.iterations;
    if (better) best = Refine(cost, best, WithBudget(cost, options));
  }
  return best;
}

}  // namespace pendulum
