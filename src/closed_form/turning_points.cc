// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/QR>

#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/period.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Indices of turning points. The first one is only a candidate: it may be the start of the recording or a sample of a
/// hold.
std::vector<Index> TurningSamples(const Eigen::VectorXd& value, double threshold) {
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
TurningPoint Vertex(const Recording& recording, Index point, double half_width) {
  const Eigen::VectorXd& time = recording.time;
  Index first = point;
  Index last = point;
  while (first > 0 && time[point] - time[first - 1] <= half_width) --first;
  while (last + 1 < time.size() && time[last + 1] - time[point] <= half_width) ++last;
  first = std::min(first, std::max<Index>(point - 1, 0));
  last = std::max(last, std::min(point + 1, time.size() - 1));
  TurningPoint sample{time[point], recording.value[point], point};
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

double TurningThreshold(const Recording& recording, double noise) {
  double range = recording.value.maxCoeff() - recording.value.minCoeff();
  // Turns over the top do not make a swing larger.
  if (recording.quantity == Quantity::kAngle && recording.is_calibrated()) range = std::min(range, 2 * kPi);
  // Twice the expected largest of N deviations, plus one, so that noise alone causes no turning point.
  const double deviations = 2 * std::sqrt(2 * std::log(static_cast<double>(recording.size()))) + 1;
  return std::max({deviations * noise, 2 * recording.resolution, 0.03 * range});
}

/// The turning points after which the reading moves by more than the threshold. The first entry is only a candidate: it
/// may be the start of the recording or lie in a hold. May be empty.
TurningPointTable FindCandidates(const Recording& recording) {
  TurningPointTable table;
  table.quantity = recording.quantity;
  table.is_calibrated = recording.is_calibrated();
  table.resolution = recording.resolution;
  table.noise = SuccessiveDifferenceNoise(recording);
  table.threshold = TurningThreshold(recording, table.noise);
  const std::vector<Index> samples = TurningSamples(recording.value, table.threshold);
  if (samples.size() < 2) return table;
  const double half_width = 0.15 * TypicalSpacing(recording.time, samples);
  table.points.reserve(samples.size());
  for (const Index sample : samples) table.points.push_back(Vertex(recording, sample, half_width));
  return table;
}

/// Whether the first candidate is a turning point. It may also be the start of the recording or lie in a hold. Then all
/// earlier readings are equal to it, or differ only by noise.
bool IsTurningPoint(const Recording& recording, const TurningPointTable& table, Index first) {
  constexpr Index kMinHeld = 8;  // fewer samples cannot distinguish noise from a slope
  const double range = recording.value.maxCoeff() - recording.value.minCoeff();
  const auto before = recording.value.head(first + 1).array();
  const double spread = std::sqrt((before - before.mean()).square().mean());
  const double farthest = (before - recording.value[first]).abs().maxCoeff();
  const bool is_noise = before.size() >= kMinHeld && spread < 2 * table.noise;
  return farthest > std::min(table.threshold, 0.1 * range) && !is_noise;
}

/// (e_{i-1} + 2 e_i + e_{i+1}) / 4 of turning points. Dry friction does not change this value.
double ZeroAbout(const std::vector<TurningPoint>& points, std::size_t i) {
  return 0.25 * (points[i - 1].value + 2 * points[i].value + points[i + 1].value);
}

/// The zero near each turning point: the median of ZeroAbout over four turning points on either side, so that the zero
/// may drift.
std::vector<double> LocalZeros(const std::vector<TurningPoint>& points) {
  constexpr std::ptrdiff_t kNeighbours = 4;
  const auto last = static_cast<std::ptrdiff_t>(points.size()) - 2;
  std::vector<double> zeros;
  for (std::ptrdiff_t i = 0; i <= last + 1; ++i) {
    const std::ptrdiff_t centre =
        std::clamp<std::ptrdiff_t>(i, std::min(1 + kNeighbours, last), std::max<std::ptrdiff_t>(last - kNeighbours, 1));
    std::vector<double> near;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(centre - kNeighbours, 1);
         j <= std::min(centre + kNeighbours, last); ++j) {
      near.push_back(ZeroAbout(points, static_cast<std::size_t>(j)));
    }
    zeros.push_back(Median(std::move(near)));
  }
  return zeros;
}

Index FirstSampleAfter(const Eigen::VectorXd& time, double instant) {
  return std::upper_bound(time.begin(), time.end(), instant) - time.begin();
}

double LongestGap(const Eigen::VectorXd& time, double from, double to) {
  const Index first = std::max<Index>(FirstSampleAfter(time, from) - 1, 0);
  const Index last = std::min<Index>(FirstSampleAfter(time, to), time.size() - 1);
  double gap = 0;
  for (Index i = first; i < last; ++i) gap = std::max(gap, time[i + 1] - time[i]);
  return gap;
}

tl::unexpected<Status> TooFewFound(const Recording& recording, std::size_t found) {
  if (recording.value.maxCoeff() == recording.value.minCoeff()) {
    return Error(StatusCode::kFailedPrecondition,
                 "the reading is constant, so there is no swing; check the sensor, or choose another column");
  }
  if (AreMaxima(recording)) {
    return Error(
        StatusCode::kFailedPrecondition,
        "the readings fall steadily on one side of 0: they may be the maxima of a swing, one of each period; give "
        "all readings of the swing, 20 or more a period");
  }
  return Error(StatusCode::kFailedPrecondition,
               "turning points above the noise between neighbouring samples: " + std::to_string(found) +
                   "; at least three turning points, with five samples or more between them, are needed: choose a "
                   "window of free swing, or record for longer");
}

}  // namespace

bool AreMaxima(const Recording& recording) {
  constexpr Index kMostMaxima = 500;
  constexpr double kNearZero = 0.05, kNearlyAll = 0.9;
  const Index count = recording.size();
  const Eigen::ArrayXd share = recording.value / recording.value[0];
  const auto falls = static_cast<double>((share.tail(count - 1) < share.head(count - 1)).count());
  return count <= kMostMaxima && share.minCoeff() > -kNearZero && share[count - 1] < 0.5 &&
         falls > kNearlyAll * static_cast<double>(count - 1);
}

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

Result<TurningPointTable> FindTurningPoints(const Recording& recording) {
  TurningPointTable table = FindCandidates(recording);
  std::vector<TurningPoint>& points = table.points;
  if (!points.empty() && !IsTurningPoint(recording, table, points[0].sample)) points.erase(points.begin());
  if (points.size() < 3) return TooFewFound(recording, points.size());
  std::vector<double> zeros, durations;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) zeros.push_back(ZeroAbout(points, i));
  for (std::size_t i = 1; i < points.size(); ++i) durations.push_back(points[i].time - points[i - 1].time);
  table.zero.value = Median(std::move(zeros));
  table.half_period = Median(std::move(durations));
  constexpr double kLongestGap = 0.6;
  for (std::size_t i = 1; i < points.size(); ++i) {
    points[i].continues =
        table.Side(i) != table.Side(i - 1) &&
        LongestGap(recording.time, points[i - 1].time, points[i].time) <= kLongestGap * table.half_period;
  }
  return table;
}

TurningPointTable FindAllTurningPoints(const Recording& recording) {
  TurningPointTable table = FindCandidates(recording);
  if (table.points.size() < 3) return table;
  table.local_zero = LocalZeros(table.points);
  std::vector<double> durations;
  for (std::size_t i = 0; i < table.half_swings(); ++i) {
    durations.push_back((table.points[i + 1].time - table.points[i].time) / table.Stretch(i));
  }
  table.half_period = Median(std::move(durations));
  return table;
}

std::vector<double> TurningPointTable::Amplitudes() const {
  std::vector<double> amplitudes;
  for (std::size_t i = 0; i < points.size(); ++i) amplitudes.push_back(Amplitude(i));
  return amplitudes;
}

double TurningPointTable::Stretch(std::size_t point) const {
  constexpr double kNearTop = 3.0;
  if (quantity == Quantity::kRate || !is_calibrated) return 1;
  return SineGravity::PeriodRatio(std::min(Amplitude(point), kNearTop));
}

double TurningPointTable::Tolerance(std::size_t point) const {
  return 0.05 * Amplitude(point) + 3 * noise + 2 * resolution;
}

std::vector<TurningPointRun> TurningPointTable::Runs() const {
  std::vector<TurningPointRun> runs;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!points[i].continues) continue;
    if (!points[i - 1].continues) runs.push_back({i - 1, i});
    runs.back().last = i;
  }
  return runs;
}

double TurningPointTable::LargestAmplitude() const {
  double largest = 0;
  for (const auto& [first, last] : Runs()) {
    for (std::size_t i = first; i <= last; ++i) largest = std::max(largest, Amplitude(i));
  }
  return largest;
}

Eigen::VectorXd TurningPointTable::ZeroWeights() const {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Index>(points.size()));
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (!points[i].continues || !points[i + 1].continues) continue;
    weights.segment<3>(static_cast<Index>(i) - 1) += Eigen::Vector3d(0.25, 0.5, 0.25);
  }
  const double sum = weights.sum();
  return sum > 0 ? Eigen::VectorXd(weights / sum) : weights;
}

}  // namespace pendulum
