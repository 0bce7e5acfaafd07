// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/oversampling.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <system_error>
#include <vector>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

/// A finite number that is all of the text but for blanks around it.
std::optional<double> NumberIn(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(" \t+"), text.size());
  const std::size_t last = text.find_last_not_of(" \t");
  if (first == text.size() || last < first) return std::nullopt;
  text = text.substr(first, last - first + 1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// The grid of a spacing that comes nearest to the values.
struct NearestGrid {
  double offset = 0;    ///< A point of the grid, 0 to one spacing.
  double distance = 0;  ///< Rms distance of the values to the grid, in spacings; 0.29 if they do not lie on it.
};

NearestGrid FindNearestGrid(const Eigen::VectorXd& values, double spacing) {
  std::complex<double> mean = 0;
  for (const double value : values) mean += std::polar(1.0, 2 * kPi * value / spacing);
  NearestGrid grid;
  grid.offset = spacing * std::arg(mean) / (2 * kPi);
  double square = 0;
  for (const double value : values) {
    const double position = (value - grid.offset) / spacing;
    square += std::pow(position - std::round(position), 2);
  }
  grid.distance = std::sqrt(square / static_cast<double>(values.size()));
  return grid;
}

/// Whether values that are not on a grid are between its points where means of n readings on these points are. With
/// little noise they are few.
bool HasMeansBetween(const Eigen::VectorXd& values, const NearestGrid& grid, double spacing, double n) {
  constexpr double kOff = 0.15;         // from a point of the grid, or of n times as many points; spacings of that grid
  constexpr double kLeastShare = 2e-3;  // of all values
  constexpr double kMost = 0.8;         // of those off the grid
  const auto is_off = [&](double value, double step) {
    const double position = (value - grid.offset) / step;
    return std::abs(position - std::round(position)) > kOff;
  };
  double off = 0, between = 0;
  for (const double value : values) {
    if (!is_off(value, spacing)) continue;
    ++off;
    if (!is_off(value, spacing / n)) ++between;
  }
  return between >= std::max(3.0, kLeastShare * static_cast<double>(values.size())) && between > kMost * off;
}

/// How far motion over values [steps] prefers some of the n residues: the size of the mean of exp(2πi value/n), 1 if
/// all have one residue. Each value counts by how far it moves in a lag, so that all residues would count alike.
struct Preference {
  double size = 0;
  double samples = 0;  ///< Effective number: by chance the square of the size is about 1/samples.
};

/// fastest: values that move further count as 0, because in fast motion the readings of a mean differ.
Preference PreferenceOf(const Eigen::VectorXi& steps, Eigen::Index lag, int n, int fastest) {
  std::vector<double> of_residue(static_cast<std::size_t>(n), 0.0);  // how far values with it have moved
  std::vector<bool> is_passed(static_cast<std::size_t>(steps.maxCoeff() / n) + 1, false);  // counts
  double all = 0, squares = 0;
  for (Eigen::Index i = lag; i + lag < steps.size(); ++i) {
    const int moved = std::abs(steps[i + lag] - steps[i - lag]);
    if (moved < n || moved > fastest) continue;  // at a turning point, or at rest
    of_residue[static_cast<std::size_t>(steps[i] % n)] += moved;
    is_passed[static_cast<std::size_t>(steps[i] / n)] = true;
    all += moved;
    squares += static_cast<double>(moved) * moved;
  }
  if (!(all > 0)) return {};
  std::complex<double> sum = 0;
  for (int residue = 0; residue < n; ++residue) {
    sum += std::polar(of_residue[static_cast<std::size_t>(residue)], 2 * kPi * residue / n);
  }
  // A slowly decaying swing shows the same values in each period.
  const auto passed = static_cast<double>(std::ranges::count(is_passed, true));
  return {std::abs(sum) / all, std::min(all * all / squares / static_cast<double>(lag), passed)};
}

/// The largest size of a preference that chance does not explain, of all motion or of slow motion; 0 if there is none.
double ClearPreference(const Eigen::VectorXi& steps, int n) {
  constexpr double kSignificant = 14;  // its square times the samples: 8e-7 by chance
  constexpr int kSlow = 4;             // counts
  double largest = 0;
  const auto consider = [&](const Preference& preference) {
    if (preference.samples * preference.size * preference.size < kSignificant) return;
    largest = std::max(largest, preference.size);
  };
  consider(PreferenceOf(steps, 1, n, std::numeric_limits<int>::max()));
  for (Eigen::Index lag = 1; lag <= 16; lag *= 4) consider(PreferenceOf(steps, lag, n, kSlow * n));
  return largest;
}

}  // namespace

int ReadingsPerMean(const Eigen::VectorXd& value, double step) {
  // Two are left out: rows that were interpolated between others look like means of two.
  constexpr std::array kNumbers = {3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 16, 20, 24, 25, 30, 32, 40, 48, 50, 60, 64};
  constexpr Eigen::Index kMostSamples = 20000;
  constexpr double kCounts = 20;  // that the motion must span
  constexpr double kMostSteps = 1e7;
  constexpr double kClear = 0.18;  // size of the preference
  constexpr double kAsMuch = 0.5;  // of the largest one: little noise prefers divisors of n as well, but no multiples
  if (!(step > 0) || value.size() == 0) return 1;
  const auto part = value.head(std::min(value.size(), kMostSamples)).array();
  if (!part.isFinite().all()) return 1;
  const double lowest = part.minCoeff();
  const double span = (part.maxCoeff() - lowest) / step;
  if (!(span < kMostSteps)) return 1;
  const Eigen::VectorXi steps = ((part - lowest) / step).round().cast<int>();
  int likeliest = 1;
  double largest = kClear / kAsMuch;
  for (const int n : kNumbers) {
    if (span < kCounts * n) break;
    const double size = ClearPreference(steps, n);
    if (size < kAsMuch * largest) continue;
    likeliest = n;
    largest = std::max(largest, size);
  }
  return likeliest;
}

std::optional<AveragingWindow> ParseAveragingWindow(std::string_view text) {
  constexpr double kLongest = kLongestAveragingWindow;
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) {
    const std::optional<double> length = NumberIn(text);
    if (!length || *length < 0 || *length > kLongest) return std::nullopt;
    return AveragingWindow{-0.5 * *length, 0.5 * *length};
  }
  const std::optional<double> from = NumberIn(text.substr(0, comma));
  const std::optional<double> to = NumberIn(text.substr(comma + 1));
  if (!from || !to || !(*from < *to) || *from < -kLongest || *to > kLongest) return std::nullopt;
  return AveragingWindow{*from, *to};
}

double CountOf(const Recording& recording) {
  return recording.oversampling.count > 0 ? recording.oversampling.count : recording.resolution;
}

void FindCountLevels(bool has_counts, Recording& recording) {
  constexpr double kOnGrid = 0.22;       // means that were rounded to a third of a step
  constexpr double kWholeCounts = 0.05;  // in counts
  Oversampling& oversampling = recording.oversampling;
  oversampling.count = 0;
  if (oversampling.readings <= 1 || !(recording.resolution > 0)) return;
  const double n = oversampling.readings;
  const NearestGrid single = FindNearestGrid(recording.value, recording.resolution);
  const bool on_resolution =
      single.distance < kOnGrid && !HasMeansBetween(recording.value, single, recording.resolution, n);
  const double count = has_counts ? 1 : on_resolution ? n * recording.resolution : recording.resolution;
  const NearestGrid means = FindNearestGrid(recording.value, count / n);
  const bool are_rounded = has_counts && recording.resolution > 0.75 * count &&
                           FindNearestGrid(recording.value, count).distance < kWholeCounts;
  if (means.distance > kOnGrid || are_rounded) return;
  oversampling.count = count;
  oversampling.level = has_counts ? 0 : means.offset;
  oversampling.is_level_known = has_counts;
  recording.resolution = count / n;
}

}  // namespace pendulum
