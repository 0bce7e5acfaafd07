// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/device_clock.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <vector>

#include <sys/timex.h>

#include "pendulum/base/median.h"

namespace pendulum {
namespace {

constexpr std::size_t kMinArrivals = 150, kArrivalsPerPart = 15;
constexpr std::size_t kMinParts = 10, kMaxParts = 32;
constexpr std::size_t kMinPoints = 6;
constexpr double kMinSeconds = 10;
constexpr double kMaxAutocorrelation = 0.9;

/// The line host = offset + scale (device - middle).
struct Line {
  double scale = 1, std_dev = 0;
  double middle = 0, offset = 0;  // device time at the middle of the points, and host time there

  double Lateness(const Arrival& arrival) const {
    return arrival.host_time - offset - scale * (arrival.device_time - middle);
  }
};

Line LeastSquares(const std::vector<Arrival>& points) {
  const auto count = static_cast<double>(points.size());
  Line line;
  double host = 0;
  for (const Arrival& point : points) {
    line.middle += point.device_time / count;
    host += point.host_time / count;
  }
  double sxx = 0, sxy = 0;
  for (const Arrival& point : points) {
    const double x = point.device_time - line.middle;
    sxx += x * x;
    sxy += x * (point.host_time - host);
  }
  line.offset = host;
  line.scale = sxy / sxx;
  double rss = 0, products = 0, before = 0;
  for (const Arrival& point : points) {
    const double lateness = line.Lateness(point);
    rss += lateness * lateness;
    products += lateness * before;
    before = lateness;
  }
  // Neighbours that are late together count as one point: the autocorrelation enlarges the error. The divisor count - 4
  // allows for Student's t, which for so few points is wider than a normal distribution.
  const double autocorrelation = rss > 0 ? std::clamp(products / rss, 0.0, kMaxAutocorrelation) : 0;
  line.std_dev = std::sqrt(rss / (count - 4) / sxx * (1 + autocorrelation) / (1 - autocorrelation));
  return line;
}

/// The earliest arrival, relative to a line of slope `scale`, in each of `parts` parts of equal duration.
std::vector<Arrival> Earliest(std::span<const Arrival> arrivals, std::size_t parts, double scale) {
  const double begin = arrivals.front().device_time;
  const double duration = (arrivals.back().device_time - begin) / static_cast<double>(parts);
  std::vector<std::optional<Arrival>> earliest(parts);
  const auto lateness = [scale](const Arrival& each) { return each.host_time - scale * each.device_time; };
  for (const Arrival& arrival : arrivals) {
    const auto at = static_cast<std::size_t>((arrival.device_time - begin) / duration);
    std::optional<Arrival>& best = earliest[std::min(at, parts - 1)];
    if (!best || lateness(arrival) < lateness(*best)) best = arrival;
  }
  std::vector<Arrival> points;
  for (const auto& each : earliest) {
    if (each) points.push_back(*each);
  }
  return points;
}

/// The points that are late by at most three standard deviations, which are estimated from the median.
std::vector<Arrival> WithoutLateArrivals(const std::vector<Arrival>& points, const Line& line) {
  constexpr double kDeviations = 3, kStdDevOfMedian = 1.4826;
  std::vector<double> sizes(points.size());
  std::ranges::transform(points, sizes.begin(), [&](const Arrival& point) { return std::abs(line.Lateness(point)); });
  const double most = kDeviations * kStdDevOfMedian * Median(sizes);
  std::vector<Arrival> punctual;
  std::ranges::copy_if(points, std::back_inserter(punctual),
                       [&](const Arrival& p) { return line.Lateness(p) <= most; });
  return punctual;
}

std::optional<Line> FitLine(std::span<const Arrival> arrivals) {
  constexpr int kMaxRounds = 20;
  constexpr double kSettled = 1e-9;
  const std::size_t parts = std::clamp(arrivals.size() / kArrivalsPerPart, kMinParts, kMaxParts);
  Line line;
  for (int round = 0; round < kMaxRounds; ++round) {
    const double before = line.scale;
    std::vector<Arrival> points = Earliest(arrivals, parts, line.scale);
    if (points.size() < kMinPoints) return std::nullopt;
    line = LeastSquares(points);
    if (std::vector<Arrival> punctual = WithoutLateArrivals(points, line); punctual.size() >= kMinPoints) {
      line = LeastSquares(punctual);
    }
    if (std::abs(line.scale - before) < kSettled) break;
  }
  return line;
}

}  // namespace

DeviceClock FitDeviceClock(std::span<const Arrival> arrivals, double polling, double host_std_dev) {
  DeviceClock clock;
  if (arrivals.size() < kMinArrivals) return clock;
  if (arrivals.back().device_time - arrivals.front().device_time < kMinSeconds) return clock;
  const std::optional<Line> line = FitLine(arrivals);
  if (!line) return clock;
  const double seconds = arrivals.back().device_time - arrivals.front().device_time;
  const double rounding = polling / std::sqrt(6.0) / seconds;  // Rounding of the times at both ends.
  const double std_dev = std::hypot(line->std_dev, rounding, host_std_dev * line->scale);
  clock.is_implausible = !(std::abs(line->scale - 1) - 3 * std_dev <= kMaxDeviation);
  if (clock.is_implausible || !(std_dev < kResonatorStdDev)) return clock;
  clock.scale = line->scale;
  clock.std_dev = std_dev;
  clock.is_measured = true;
  return clock;
}

double HostClockStdDev() {
  constexpr double kQuartz = 30e-6, kDisciplined = 10e-6;
  timex state{};
  const int status = ::adjtimex(&state);
  return status == -1 || status == TIME_ERROR ? kQuartz : kDisciplined;
}

}  // namespace pendulum
