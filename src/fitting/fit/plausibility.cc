// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/plausibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/friction/dahl.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Residuals that leave less of the variance than this may be anything: the trajectory is near the readings.
constexpr double kNegligibleShare = 0.03;

constexpr const char* kWindowAdvice = "; choose a window of free swing with --from and --to, or check the recording";

bool IsJudged(const FitProblem& problem) {
  const Quantity quantity = problem.data.quantity;
  return (quantity == Quantity::kAngle || quantity == Quantity::kRate) && problem.zero() < problem.infos.size();
}

/// The zero at the middle of the recording, in the unit of the readings.
double MiddleZero(const FitProblem& problem, const Solution& solution) {
  const double zero = solution.parameters[problem.zero()];
  if (problem.zero_motion != ZeroMotion::kDrifts) return zero;
  return zero + 0.5 * problem.data.time.back() * solution.parameters.back();
}

std::string ZeroReason(const FitProblem& problem, const Solution& solution) {
  constexpr double kOutside = 0.25;  // of the readings' range
  const std::size_t place = problem.zero();
  if (!IsJudged(problem) || problem.solve.fixed[place] || problem.censored > 0) return "";
  const auto values = problem.data.values();
  const double low = values.minCoeff(), high = values.maxCoeff(), margin = kOutside * (high - low);
  const double zero = MiddleZero(problem, solution);
  if (zero >= low - margin && zero <= high + margin) return "";
  return "the fitted " + std::string(problem.infos[place].name) + " of " +
         NumberText(problem.Reported(place, zero), 3) + " is outside the readings" + kWindowAdvice;
}

std::string HysteresisReason(const FitProblem& problem, const Solution& solution) {
  constexpr double kMostCounts = 5;
  const std::optional<std::size_t> place = problem.Find(kHysteresis.name);
  const double count = solution.noise.resolution;
  if (!place || problem.solve.fixed[*place] || !(count > 0)) return "";
  if (solution.noise.family != NoiseFamily::kEdges) return "";
  const double counts = std::abs(solution.parameters[*place]) / count;
  if (counts <= kMostCounts) return "";
  return "the fitted hysteresis is " + NumberText(counts, 2) +
         " counts, but an encoder's is a fraction of one: it stands for something that the model lacks" + kWindowAdvice;
}

/// The multiple of the trajectory that fits the first half swing best.
struct FirstHalfSwing {
  double multiple = 1;
  Index samples = 0;
};

FirstHalfSwing CompareFirstHalfSwing(const FitProblem& problem, const Solution& solution) {
  const std::optional<std::size_t> release = problem.Find(kReleaseTime.name);
  const double from = release ? solution.parameters[*release] : 0.0;
  const double to = from + kPi * std::sqrt(solution.parameters[0]);
  const auto values = problem.data.values();
  double product = 0, square = 0;
  FirstHalfSwing first;
  for (Index i = 0; i < values.size(); ++i) {
    const double time = problem.data.time[static_cast<std::size_t>(i)];
    const bool is_read = !solution.noise.IsCensored(values[i]) && !solution.noise.IsSilence(values[i]);
    if (time < from || time > to || !is_read) continue;
    const double zero = solution.parameters[problem.zero()];
    product += (values[i] - zero) * (solution.readings[i] - zero);
    square += (solution.readings[i] - zero) * (solution.readings[i] - zero);
    ++first.samples;
  }
  if (square > 0) first.multiple = product / square;
  return first;
}

std::string StartReason(const FitProblem& problem, const Solution& solution, bool correlated) {
  constexpr double kMisses = 0.3;
  constexpr Index kEnough = 6;  // samples in a half swing
  const auto is_fixed = [&](const ParameterInfo& info) {
    const std::optional<std::size_t> place = problem.Find(info.name);
    return place && problem.solve.fixed[*place];
  };
  if (!IsJudged(problem) || !correlated || is_fixed(kReleaseAngle) || is_fixed(kInitialAngle)) return "";
  if (problem.UnexplainedShare(solution.readings) < kNegligibleShare) return "";
  const FirstHalfSwing first = CompareFirstHalfSwing(problem, solution);
  if (first.samples < kEnough || std::abs(first.multiple - 1) <= kMisses) return "";
  return "the trajectory misses the start: in the first half swing the readings swing " +
         NumberText(first.multiple, 2) + " times as far" + kWindowAdvice;
}

/// Bristles that bend over more than the swing never slide: they are a spring that follows much that is no swing.
std::string BristlesReason(const FitProblem& problem, const Solution& solution, bool correlated) {
  const std::optional<std::size_t> place = problem.Find(kPreslidingAngle.name);
  if (!place || problem.solve.fixed[*place] || !correlated) return "";
  const double zero = solution.parameters[problem.zero()];
  const double amplitude = (solution.readings.array() - zero).abs().maxCoeff();
  if (solution.parameters[*place] <= amplitude) return "";
  return "presliding_angle is larger than the swing, so that the friction is a spring's" + std::string(kWindowAdvice);
}

}  // namespace

std::string ImplausibleReason(const FitProblem& problem, const Solution& solution, bool correlated) {
  for (const std::string& reason :
       {ZeroReason(problem, solution), HysteresisReason(problem, solution), StartReason(problem, solution, correlated),
        BristlesReason(problem, solution, correlated)}) {
    if (!reason.empty()) return "the best trajectory does not describe the readings: " + reason;
  }
  return "";
}

std::string TooFewEffectiveSamples(double effective_samples, int free_parameters, double unexplained) {
  if (unexplained < kNegligibleShare || effective_samples > free_parameters) return "";
  return "the best trajectory does not describe the readings: it leaves " +
         std::to_string(std::lround(100 * unexplained)) + " % of their variance, and these residuals are worth only " +
         NumberText(effective_samples, 2) + " independent readings for " + std::to_string(free_parameters) +
         " parameters" + kWindowAdvice;
}

}  // namespace pendulum
