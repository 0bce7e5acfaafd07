// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/period.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pendulum/base/physics.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

/// Crossing times against the time they would take at ω0 = 1, both with the mean of each run subtracted.
std::pair<std::vector<double>, std::vector<double>> CrossingsAgainstPhase(const HalfSwingTable& table,
                                                                          double natural_frequency) {
  std::vector<double> phase, time;
  std::size_t run_start = 0;
  const auto centre_run = [&run_start](std::vector<double>& values) {
    const double count = static_cast<double>(values.size() - run_start);
    double mean = 0;
    for (std::size_t i = run_start; i < values.size(); ++i) mean += values[i] / count;
    for (std::size_t i = run_start; i < values.size(); ++i) values[i] -= mean;
  };
  for (const HalfSwing& half : table.half_swings) {
    if (!half.continues) {
      centre_run(phase), centre_run(time);
      run_start = phase.size();
    }
    const double amplitude = AngleAmplitude(table.quantity, half.before, natural_frequency);
    phase.push_back(half.continues ? phase.back() + kPi * PeriodRatio(amplitude) : 0.0);
    time.push_back(half.crossing);
  }
  centre_run(phase), centre_run(time);
  return {phase, time};
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

double AngleAmplitude(Quantity quantity, double amplitude, double natural_frequency) {
  constexpr double kLargest = 3.1;
  if (quantity == Quantity::kAngle) return std::min(amplitude, kLargest);
  return std::min(2 * std::asin(std::min(amplitude / (2 * natural_frequency), 1.0)), kLargest);
}

double NaturalFrequency(const HalfSwingTable& table) {
  // An angle's amplitude does not depend on ω0 and one pass is final; a rate's does, and the correction converges fast.
  double natural_frequency = kUnbounded;
  for (int pass = 0; pass < (table.quantity == Quantity::kAngle ? 1 : 8); ++pass) {
    const auto [phase, time] = CrossingsAgainstPhase(table, natural_frequency);
    double phase_phase = 0, phase_time = 0;
    for (std::size_t i = 0; i < phase.size(); ++i) {
      phase_phase += phase[i] * phase[i];
      phase_time += phase[i] * time[i];
    }
    natural_frequency = phase_phase / phase_time;
  }
  return natural_frequency;
}

}  // namespace pendulum
