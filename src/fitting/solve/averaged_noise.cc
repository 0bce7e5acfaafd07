// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/averaged_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>
#include <vector>

#include "fitting/likelihood/averaged_counts.h"
#include "pendulum/fitting/likelihood/edge_noise.h"

namespace pendulum {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Values of σ to compare [counts].
constexpr std::array kSigmas = {0.05, 0.12, 0.2, 0.3, 0.42, 0.55};

/// Some samples of the problem, evenly chosen, with their motion per second and per second².
struct SomeSamples {
  VectorXd value;
  VectorXd reading;
  std::vector<WindowMotion> motion;  // for a window of 1 s
};

/// The motion of the value in a window of 1 s at each of the samples.
std::vector<WindowMotion> MotionsPerSecond(const TrajectoryCost& cost, const FitProblem& problem,
                                           const Solution& solution) {
  const auto size = static_cast<Index>(problem.data.time.size());
  std::vector<WindowMotion> motions(static_cast<std::size_t>(size));
  MotionStates states;
  const bool is_direct = problem.data.sensor.kind == SensorKind::kDirect;
  if (is_direct && cost.Motion(solution.parameters, false, &states)) {
    const bool is_rate = problem.data.quantity == Quantity::kRate;
    for (Index i = 0; i < size; ++i) {
      motions[static_cast<std::size_t>(i)] =
          is_rate ? WindowMotion{states.value[2][i], 0} : WindowMotion{states.value[1][i], 0.5 * states.value[2][i]};
    }
    return motions;
  }
  const VectorXd rates = RatesOf(problem.data.times(), solution.readings);
  for (Index i = 0; i < size; ++i) motions[static_cast<std::size_t>(i)].slope = rates[i];
  return motions;
}

WindowMotion InWindow(const WindowMotion& per_second, double window) {
  return {per_second.slope * window, per_second.bend * window * window};
}

SomeSamples SomeSamplesOf(const FitProblem& problem, const Solution& solution,
                          const std::vector<WindowMotion>& motions) {
  constexpr Index kMost = 1500;
  const auto size = static_cast<Index>(problem.data.time.size());
  const Index count = std::min(size, kMost);
  SomeSamples some{VectorXd(count), VectorXd(count), {}};
  for (Index k = 0; k < count; ++k) {
    const Index i = k * size / count;
    some.value[k] = problem.data.value[static_cast<std::size_t>(i)];
    some.reading[k] = solution.readings[i];
    some.motion.push_back(motions[static_cast<std::size_t>(i)]);
  }
  return some;
}

/// A candidate and its log-likelihood.
struct Candidate {
  double level = 0;
  double window = 0;  // s
  double sigma = 0;   // counts
  double log = -kInfinity;
};

double LogOf(const SomeSamples& some, NoiseModel noise, const Candidate& candidate) {
  noise.averaging.level = candidate.level;
  const double sigma = candidate.sigma;
  double sum = 0;
  for (Index k = 0; k < some.value.size(); ++k) {
    noise.averaging.motion = InWindow(some.motion[static_cast<std::size_t>(k)], candidate.window);
    sum += CountSumLog(CountSumOf(noise, some.value[k]), InCounts(noise, some.reading[k]), sigma);
  }
  return sum;
}

/// Keeps the likelier of `best` and the candidates with one of the values of σ.
void TrySigmas(const SomeSamples& some, const NoiseModel& noise, std::span<const double> sigmas, Candidate candidate,
               Candidate& best) {
  for (const double sigma : sigmas) {
    candidate.sigma = sigma;
    candidate.log = LogOf(some, noise, candidate);
    if (candidate.log > best.log) best = candidate;
  }
}

/// Improves the length of the window by bisection between the lengths on both sides of the best one.
void RefineWindow(const SomeSamples& some, const NoiseModel& noise, const std::vector<double>& windows,
                  Candidate& best) {
  constexpr int kRounds = 3;
  const auto at = std::ranges::find(windows, best.window);
  double below = at == windows.begin() ? *at : *std::prev(at);
  double above = std::next(at) == windows.end() ? *at : *std::next(at);
  for (int round = 0; round < kRounds; ++round) {
    const double middle = best.window;
    const double lower = 0.5 * (below + middle), higher = 0.5 * (middle + above);
    const std::array sigmas = {0.8 * best.sigma, best.sigma, 1.25 * best.sigma};
    for (const double length : {lower, higher}) {
      TrySigmas(some, noise, sigmas, {best.level, length, 0, -kInfinity}, best);
    }
    if (best.window < middle) {
      above = middle;
    } else if (best.window > middle) {
      below = middle;
    } else {
      below = lower;
      above = higher;
    }
  }
}

double MedianInterval(const std::vector<double>& time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Lengths of the averaging window that come into question [s].
std::vector<double> Windows(const FitProblem& problem) {
  if (problem.oversampling.window) return {problem.oversampling.window->length()};
  const double longest = MedianInterval(problem.data.time);
  std::vector<double> windows = {0};
  for (const double part : {0.06, 0.12, 0.25, 0.5, 0.75, 1.0}) windows.push_back(part * longest);
  return windows;
}

}  // namespace

bool HasMeans(const FitProblem& problem) { return problem.oversampling.readings > 1; }

bool MayShowRounding(const FitProblem& problem, double residual_std_dev) {
  constexpr double kRounded = 0.4;  // counts; residuals of rounding alone have 0.29
  const double normal = 1.2 / std::sqrt(static_cast<double>(problem.oversampling.readings));
  return residual_std_dev < std::max(kRounded, normal) * problem.oversampling.count;
}

void SetWindowMotions(const TrajectoryCost& cost, const FitProblem& problem, const Solution& solution, double window,
                      NoiseModel& noise) {
  noise.averaging.motions = nullptr;
  if (window == 0) return;
  std::vector<WindowMotion> motions = MotionsPerSecond(cost, problem, solution);
  for (WindowMotion& motion : motions) motion = InWindow(motion, window);
  noise.averaging.motions = std::make_shared<const std::vector<WindowMotion>>(std::move(motions));
}

NoiseModel LikeliestAveraging(const TrajectoryCost& cost, const FitProblem& problem, const Solution& solution,
                              double* window) {
  constexpr std::array kForLevels = {0.1, 0.3};  // values of σ for the choice of levels
  NoiseModel noise = solution.noise;
  const double count = noise.averaging.count;
  const double rms = problem.RmsResidual(solution.readings) / count;
  const SomeSamples some = SomeSamplesOf(problem, solution, MotionsPerSecond(cost, problem, solution));
  const std::vector<double> windows = Windows(problem);
  Candidate best{problem.oversampling.level, windows.front(), 0, -kInfinity};
  if (!problem.oversampling.is_level_known) {
    Candidate trial = best;
    for (int k = 0; k < noise.averaging.readings; ++k) {
      trial.level = problem.oversampling.level + k * count / noise.averaging.readings;
      TrySigmas(some, noise, kForLevels, trial, best);
    }
  }
  best.log = -kInfinity;
  for (const double length : windows) TrySigmas(some, noise, kSigmas, {best.level, length, 0, -kInfinity}, best);
  if (windows.size() > 1) RefineWindow(some, noise, windows, best);
  const double readings = noise.averaging.readings;
  const std::array normal = {std::sqrt(std::max(readings * rms * rms - 1.0 / 12, kContinuousSigma * kContinuousSigma))};
  TrySigmas(some, noise, normal, best, best);
  noise.sigma = best.sigma * count;
  noise.averaging.level = best.level;
  *window = best.window;
  SetWindowMotions(cost, problem, solution, best.window, noise);
  return noise;
}

}  // namespace pendulum
