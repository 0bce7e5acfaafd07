// SPDX-License-Identifier: Apache-2.0
#include "closed_form/driven_part.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pendulum/base/median.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

/// Running medians of the means of neighbouring amplitudes of a run. An error of the zero cancels in the means, and a
/// few outliers, as beside a gap, in the medians.
std::vector<double> PairAmplitudes(const TurningPointTable& table, const TurningPointRun& run) {
  constexpr std::size_t kHalfWidth = 3;
  std::vector<double> pairs;
  for (std::size_t i = run.first; i < run.last; ++i) {
    pairs.push_back(0.5 * (table.Amplitude(i) + table.Amplitude(i + 1)));
  }
  std::vector<double> medians;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t reach = std::min({i, kHalfWidth, pairs.size() - 1 - i});
    const auto middle = pairs.begin() + static_cast<std::ptrdiff_t>(i);
    const auto span = static_cast<std::ptrdiff_t>(reach);
    medians.push_back(Median(std::vector<double>(middle - span, middle + span + 1)));
  }
  return medians;
}

/// Whether the amplitude is kept before pair `k` and decays after it. The losses must be clear of the noise.
bool IsKnee(const std::vector<double>& pairs, std::size_t k, double noise) {
  constexpr std::size_t kMinCount = 8;
  constexpr double kDecayed = 0.9, kKept = 0.2, kClear = 6;
  const auto after = pairs.begin() + static_cast<std::ptrdiff_t>(k);
  const auto decayed = std::find_if(after, pairs.end(), [&](double pair) { return pair < kDecayed * *after; });
  const std::size_t count = std::max(static_cast<std::size_t>(decayed - after), kMinCount);
  if (decayed == pairs.end() || k < count || k + count >= pairs.size()) return false;
  const double loss_before = pairs[k - count] - pairs[k], loss = pairs[k] - pairs[k + count];
  return loss_before < kKept * loss && loss - loss_before > kClear * noise;
}

/// What the curvature of a swing adds to the noise between neighbouring samples (SuccessiveDifferenceNoise): the 68 %
/// quantile of A |cos φ| (1 - cos ωh), divided by sqrt(1.5).
double CurvatureNoise(const TurningPointTable& table, const std::vector<double>& amplitudes) {
  constexpr double kQuantile = 0.715;
  const std::vector<TurningPoint>& points = table.points;
  const auto samples = static_cast<double>(points.back().sample - points.front().sample);
  if (!(samples > 0)) return 0;
  return kQuantile * Median(amplitudes) * (1 - std::cos(kPi * static_cast<double>(points.size() - 1) / samples));
}

}  // namespace

std::size_t EndOfDrive(const TurningPointTable& table, const TurningPointRun& run) {
  constexpr double kDecayed = 0.7, kSame = 0.99;
  const std::vector<double> pairs = PairAmplitudes(table, run);
  if (pairs.empty()) return run.first;
  constexpr double kLeast = 0.2;  // of the noise, because its curvature is known only roughly
  const double noise = std::max(table.noise - CurvatureNoise(table, pairs), kLeast * table.noise) + table.resolution;
  for (std::size_t k = pairs.size() - 1; k > 0; --k) {
    if (pairs.back() > kDecayed * pairs[k] || !IsKnee(pairs, k, noise)) continue;
    const auto decays = std::find_if(pairs.begin() + static_cast<std::ptrdiff_t>(k), pairs.end(),
                                     [&](double pair) { return pair < kSame * pairs[k]; });
    // The drive may still act on the first turning point of this pair.
    return run.first + static_cast<std::size_t>(decays - pairs.begin()) + 1;
  }
  return run.first;
}

}  // namespace pendulum
