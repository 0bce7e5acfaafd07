// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/oversampling.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <complex>
#include <system_error>

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

}  // namespace

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
  const bool on_resolution = FindNearestGrid(recording.value, recording.resolution).distance < kOnGrid;
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
