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

/// Subtracts the mean of values[begin] to the last value from each of these values.
void Centre(std::size_t begin, std::vector<double>& values) {
  const auto count = static_cast<double>(values.size() - begin);
  double mean = 0;
  for (std::size_t i = begin; i < values.size(); ++i) mean += values[i] / count;
  for (std::size_t i = begin; i < values.size(); ++i) values[i] -= mean;
}

/// The zero crossings of all runs [s], each run relative to its mean.
std::vector<double> CrossingTimes(const Recording& recording, const TurningPointTable& table) {
  std::vector<double> times;
  for (const auto& [first, last] : table.Runs()) {
    const std::size_t begin = times.size();
    for (std::size_t i = first + 1; i <= last; ++i) times.push_back(ZeroCrossing(recording, table, i));
    Centre(begin, times);
  }
  return times;
}

/// The times that the zero crossings would have at ω0 = 1.
std::vector<double> CrossingPhases(const TurningPointTable& table, Gravity gravity, double natural_frequency) {
  std::vector<double> phases;
  for (const auto& [first, last] : table.Runs()) {
    const std::size_t begin = phases.size();
    phases.push_back(0);
    for (std::size_t i = first + 1; i < last; ++i) {
      const double amplitude = AngleAmplitude(table.quantity, table.Amplitude(i), natural_frequency, gravity);
      phases.push_back(phases.back() + kPi * gravity.PeriodRatio(amplitude));
    }
    Centre(begin, phases);
  }
  return phases;
}

/// ω0 from the slope of the crossings, common to all runs. Amplitudes of a rate are computed with `natural_frequency`.
double FrequencyAtAmplitudesOf(const std::vector<double>& time, const TurningPointTable& table, Gravity gravity,
                               double natural_frequency) {
  const std::vector<double> phase = CrossingPhases(table, gravity, natural_frequency);
  double phase_phase = 0, phase_time = 0;
  for (std::size_t i = 0; i < phase.size(); ++i) {
    phase_phase += phase[i] * phase[i];
    phase_time += phase[i] * time[i];
  }
  return phase_phase / phase_time;
}

}  // namespace

double AngleAmplitude(Quantity quantity, double amplitude, double natural_frequency, Gravity gravity) {
  constexpr double kBelowTop = kPi - 3.1;
  const double largest = gravity.top() - kBelowTop;
  if (quantity == Quantity::kAngle) return std::min(amplitude, largest);
  const double chord = std::min(amplitude / natural_frequency, gravity.Chord(gravity.top()));
  return std::min(gravity.AngleOfChord(chord), largest);
}

/// Fits a least-squares line of time on reading to the samples within 0.35 of the smaller amplitude. With too few such
/// samples, interpolates between the two samples around the passage.
double ZeroCrossing(const Recording& recording, const TurningPointTable& table, std::size_t point) {
  const TurningPoint &from = table.points[point - 1], &to = table.points[point];
  const double zero = table.zero.value;
  const double near = 0.35 * std::min(table.Amplitude(point - 1), table.Amplitude(point));
  double n = 0, sum_y = 0, sum_t = 0, sum_yy = 0, sum_yt = 0;
  Eigen::Index i = std::upper_bound(recording.time.begin(), recording.time.end(), from.time) - recording.time.begin();
  const double sign = to.value > from.value ? 1 : -1;
  double fallback = 0.5 * (from.time + to.time);
  for (; i < recording.size() && recording.time[i] < to.time; ++i) {
    const double y = recording.value[i] - zero;
    const double t = recording.time[i] - from.time;
    if (std::abs(y) < near) {
      n += 1, sum_y += y, sum_t += t, sum_yy += y * y, sum_yt += y * t;
    }
    const double y0 = i > 0 ? recording.value[i - 1] - zero : y;
    if (i > 0 && sign * y0 < 0 && sign * y >= 0) {
      fallback = recording.time[i - 1] + (recording.time[i] - recording.time[i - 1]) * y0 / (y0 - y);
    }
  }
  const double determinant = n * sum_yy - sum_y * sum_y;
  if (n < 4 || !(determinant > 0)) return fallback;
  return from.time + (sum_yy * sum_t - sum_y * sum_yt) / determinant;
}

Result<double> NaturalFrequency(const Recording& recording, const TurningPointTable& table, Gravity gravity) {
  const std::vector<TurningPointRun> runs = table.Runs();
  if (std::ranges::none_of(runs, [](const TurningPointRun& run) { return run.last - run.first > 1; })) {
    return Error(StatusCode::kFailedPrecondition,
                 "there are no two successive half swings without a gap; record for longer or choose another window");
  }
  const std::vector<double> times = CrossingTimes(recording, table);
  const auto frequency_at = [&](double frequency) { return FrequencyAtAmplitudesOf(times, table, gravity, frequency); };
  if (table.quantity == Quantity::kAngle || gravity.is_linear()) return frequency_at(kUnbounded);
  // The amplitudes of a rate also depend on ω0. A larger ω0 means smaller amplitudes, and these give a smaller ω0, so
  // there is exactly one solution. At the smallest possible ω0 the largest peak would carry the pendulum to the top.
  const double smallest = table.LargestAmplitude() / gravity.Chord(gravity.top());
  const double largest = std::max(frequency_at(smallest), 1.01 * smallest);
  const auto excess = [&](double frequency) { return frequency_at(frequency) - frequency; };
  if (!(excess(smallest) > 0)) return smallest;
  if (!(excess(largest) < 0)) return largest;
  std::uintmax_t max_evaluations = 100;
  const boost::math::tools::eps_tolerance<double> precise(40);
  const auto [low, high] = boost::math::tools::toms748_solve(excess, smallest, largest, precise, max_evaluations);
  return 0.5 * (low + high);
}

}  // namespace pendulum
