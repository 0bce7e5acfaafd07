// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/period.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

/// Crossing times, and the times they would have at ω0 = 1. The mean of each run is subtracted from both.
std::pair<std::vector<double>, std::vector<double>> CrossingsAgainstPhase(const HalfSwingTable& table,
                                                                          double natural_frequency) {
  std::vector<double> phase, time;
  std::size_t run_start = 0;
  const auto centre_run = [&run_start](std::vector<double>& values) {
    const auto count = static_cast<double>(values.size() - run_start);
    double mean = 0;
    for (std::size_t i = run_start; i < values.size(); ++i) mean += values[i] / count;
    for (std::size_t i = run_start; i < values.size(); ++i) values[i] -= mean;
  };
  for (const HalfSwing& half : table.half_swings) {
    if (!half.continues) {
      centre_run(phase), centre_run(time);
      run_start = phase.size();
    }
    const double amplitude = AngleAmplitude(table.quantity, half.before, natural_frequency, table.gravity);
    const double ratio = table.gravity == Gravity::kSine ? PeriodRatio(amplitude) : 1.0;
    phase.push_back(half.continues ? phase.back() + kPi * ratio : 0.0);
    time.push_back(half.crossing);
  }
  centre_run(phase), centre_run(time);
  return {phase, time};
}

/// ω0 from the slope of the crossings, common to all runs without gaps. Amplitudes are computed with the ω0 given.
double FrequencyAtAmplitudesOf(const HalfSwingTable& table, double natural_frequency) {
  const auto [phase, time] = CrossingsAgainstPhase(table, natural_frequency);
  double phase_phase = 0, phase_time = 0;
  for (std::size_t i = 0; i < phase.size(); ++i) {
    phase_phase += phase[i] * phase[i];
    phase_time += phase[i] * time[i];
  }
  return phase_phase / phase_time;
}

}  // namespace

double PeriodRatio(double amplitude) {
  double a = 1;
  double b = std::cos(0.5 * amplitude);
  while (std::abs(a - b) > 1e-15 * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

double AngleAmplitude(Quantity quantity, double amplitude, double natural_frequency, Gravity gravity) {
  if (gravity == Gravity::kLinear) return quantity == Quantity::kAngle ? amplitude : amplitude / natural_frequency;
  constexpr double kLargest = 3.1;
  if (quantity == Quantity::kAngle) return std::min(amplitude, kLargest);
  return std::min(2 * std::asin(std::min(amplitude / (2 * natural_frequency), 1.0)), kLargest);
}

double NaturalFrequency(const HalfSwingTable& table) {
  if (table.quantity == Quantity::kAngle || table.gravity == Gravity::kLinear)
    return FrequencyAtAmplitudesOf(table, kUnbounded);
  // The amplitudes of a rate also depend on ω0. A larger ω0 means smaller amplitudes, and these give a smaller ω0, so
  // there is exactly one solution. At the smallest possible ω0 the largest peak would carry the pendulum to the top.
  double peak = 0;
  for (const HalfSwing& half : table.half_swings) peak = std::max({peak, half.before, half.after});
  const double smallest = 0.5 * peak;
  const double largest = std::max(FrequencyAtAmplitudesOf(table, smallest), 1.01 * smallest);
  const auto excess = [&](double frequency) { return FrequencyAtAmplitudesOf(table, frequency) - frequency; };
  if (!(excess(smallest) > 0)) return smallest;
  if (!(excess(largest) < 0)) return largest;
  std::uintmax_t max_evaluations = 100;
  const boost::math::tools::eps_tolerance<double> precise(40);
  const auto [low, high] = boost::math::tools::toms748_solve(excess, smallest, largest, precise, max_evaluations);
  return 0.5 * (low + high);
}

}  // namespace pendulum
