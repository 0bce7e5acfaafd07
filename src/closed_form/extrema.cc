// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/extrema.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/QR>

#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Indices of confirmed turning points, preceded by the first candidate: the start of the recording or a sample of its
/// hold.
std::vector<Index> TurningPoints(const Eigen::VectorXd& value, double threshold) {
  std::vector<Index> points;
  Index highest = 0;
  Index lowest = 0;
  int direction = 0;  // of the reading; 0 before the first move beyond the threshold
  for (Index i = 1; i < value.size(); ++i) {
    if (value[i] > value[highest]) highest = i;
    if (value[i] < value[lowest]) lowest = i;
    if (direction >= 0 && value[highest] - value[i] > threshold) {
      points.push_back(highest);
      direction = -1;
      lowest = i;
    } else if (direction <= 0 && value[i] - value[lowest] > threshold) {
      points.push_back(lowest);
      direction = 1;
      highest = i;
    }
  }
  return points;
}

double TypicalSpacing(const Eigen::VectorXd& time, const std::vector<Index>& points) {
  std::vector<double> spacing;
  for (std::size_t i = 1; i < points.size(); ++i) spacing.push_back(time[points[i]] - time[points[i - 1]]);
  return Median(std::move(spacing));
}

/// Vertex of the least-squares parabola through the samples within `half_width` of sample `point`, at least one on each
/// side. Returns the sample itself if the parabola has no vertex among them.
Extremum Vertex(const Recording& recording, Index point, double half_width) {
  const Eigen::VectorXd& time = recording.time;
  Index first = point;
  Index last = point;
  while (first > 0 && time[point] - time[first - 1] <= half_width) --first;
  while (last + 1 < time.size() && time[last + 1] - time[point] <= half_width) ++last;
  first = std::min(first, std::max<Index>(point - 1, 0));
  last = std::max(last, std::min(point + 1, time.size() - 1));
  const Extremum sample{time[point], recording.value[point], point};
  const Index count = last - first + 1;
  if (count < 3) return sample;
  const Eigen::ArrayXd t = time.segment(first, count).array() - time[point];
  Eigen::MatrixX3d basis(count, 3);
  basis << Eigen::ArrayXd::Ones(count), t, t.square();
  const Eigen::Vector3d c = basis.colPivHouseholderQr().solve(recording.value.segment(first, count));
  const double vertex = -0.5 * c[1] / c[2];
  if (!(vertex >= t[0] && vertex <= t[count - 1])) return sample;
  return {time[point] + vertex, c[0] + 0.5 * c[1] * vertex, point};
}

}  // namespace

/// The 68 % quantile of the distances divided by sqrt(1 + w² + (1-w)²), where w is the interpolation's weight.
double SuccessiveDifferenceNoise(const Recording& recording) {
  const Eigen::VectorXd& t = recording.time;
  const Eigen::VectorXd& y = recording.value;
  std::vector<double> distance;
  distance.reserve(static_cast<std::size_t>(y.size()));
  for (Index i = 1; i + 1 < y.size(); ++i) {
    const double w = (t[i] - t[i - 1]) / (t[i + 1] - t[i - 1]);
    const double line = (1 - w) * y[i - 1] + w * y[i + 1];
    distance.push_back(std::abs(y[i] - line) / std::sqrt(1 + w * w + (1 - w) * (1 - w)));
  }
  const auto quantile = distance.begin() + static_cast<std::ptrdiff_t>(0.6827 * static_cast<double>(distance.size()));
  std::nth_element(distance.begin(), quantile, distance.end());
  return *quantile;
}

double TurningThreshold(const Recording& recording, double noise) {
  double range = recording.value.maxCoeff() - recording.value.minCoeff();
  // Turns over the top do not make a swing larger.
  if (recording.quantity == Quantity::kAngle && recording.is_calibrated()) range = std::min(range, 2 * kPi);
  // Twice the expected largest of N deviations, plus one, so that noise alone causes no turning point.
  const double deviations = 2 * std::sqrt(2 * std::log(static_cast<double>(recording.size()))) + 1;
  return std::max({deviations * noise, 2 * recording.resolution, 0.03 * range});
}

std::vector<Extremum> FindTurningPoints(const Recording& recording, double threshold) {
  const std::vector<Index> points = TurningPoints(recording.value, threshold);
  if (points.size() < 2) return {};
  const double half_width = 0.15 * TypicalSpacing(recording.time, points);
  std::vector<Extremum> turns;
  turns.reserve(points.size());
  for (const Index point : points) turns.push_back(Vertex(recording, point, half_width));
  return turns;
}

Result<std::vector<Extremum>> FindExtrema(const Recording& recording) {
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  const double noise = SuccessiveDifferenceNoise(recording);
  const double threshold = TurningThreshold(recording, noise);
  std::vector<Extremum> extrema = FindTurningPoints(recording, threshold);
  if (!extrema.empty()) {
    // The first candidate may be the start of the recording or lie in its hold. Then all earlier readings are equal to
    // it, or differ only by noise.
    const Index first = extrema[0].sample;
    const auto before = recording.value.head(first + 1).array();
    const double spread = std::sqrt((before - before.mean()).square().mean());
    const double farthest = (before - recording.value[first]).abs().maxCoeff();
    constexpr Index kMinHeld = 8;  // fewer samples cannot distinguish noise from a slope
    const bool is_noise = before.size() >= kMinHeld && spread < 2 * noise;
    const bool turned = farthest > std::min(threshold, 0.1 * range) && !is_noise;
    if (!turned) extrema.erase(extrema.begin());
  }
  if (extrema.size() >= 3) return extrema;
  if (range == 0) {
    return Error(StatusCode::kFailedPrecondition,
                 "the reading is constant: there is no swing in it; check the sensor, or choose another column");
  }
  return Error(
      StatusCode::kFailedPrecondition,
      "turning points that stand out of the noise between neighbouring samples: " + std::to_string(extrema.size()) +
          "; at least three turning points, with five samples or more between them, are needed to tell a swing: choose "
          "a "
          "window of free swing, or record for longer");
}

}  // namespace pendulum
