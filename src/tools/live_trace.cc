// SPDX-License-Identifier: Apache-2.0
#include "tools/live_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "pendulum/base/format.h"
#include "pendulum/base/staged_file.h"

namespace pendulum {
namespace {

constexpr std::size_t kMaxColumns = 66, kLabel = 9;  // columns of the plot, and of the numbers next to it
constexpr std::size_t kPictureRows = LiveTrace::kRows - 1;

std::string RightAligned(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

/// A number with fixed decimals. A column that is redrawn must keep its width.
std::string Fixed(double value, int decimals) {
  const double scale = std::pow(10, decimals);
  std::string text = std::to_string(std::round(std::abs(value) * scale) / scale);
  text.resize(text.find('.') + (decimals > 0 ? 1 + static_cast<std::size_t>(decimals) : 0));
  return (text.find_first_not_of("0.") != std::string::npos && value < 0 ? "-" : "") + text;
}

/// The smallest and the largest value in a column.
struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

}  // namespace

void LiveTrace::Add(double time, double value, double counts, double full_scale) {
  points_.push_back({time, value});
  while (time - points_.front().time > kSeconds) points_.pop_front();
  counts_ = counts;
  full_scale_ = full_scale;
}

std::vector<std::string> LiveTrace::Plot(std::size_t width) const {
  constexpr std::size_t kBesides = kLabel + 3;  // label, blank, frame, and one in reserve
  std::vector<std::string> rows(kRows);
  if (points_.empty() || width < kBesides + 2) return rows;
  const std::size_t columns = std::min(kMaxColumns, width - kBesides);
  std::vector<Span> spans(columns);
  const auto last = static_cast<double>(columns - 1);
  double low = points_.front().value, high = low;
  const double begin = points_.back().time - kSeconds;
  for (const Point& point : points_) {
    const double at = (point.time - begin) / kSeconds * last;
    Span& span = spans[static_cast<std::size_t>(std::clamp(at, 0.0, last))];
    span.low = std::min(span.low, point.value);
    span.high = std::max(span.high, point.value);
    low = std::min(low, point.value);
    high = std::max(high, point.value);
  }
  const double least = 2;  // deg or counts: noise alone must not fill the plot
  if (high - low < least) std::tie(low, high) = std::pair((low + high - least) / 2, (low + high + least) / 2);
  const double step = (high - low) / (kPictureRows - 1);
  for (std::size_t row = 0; row < kPictureRows; ++row) {
    const double level = high - step * static_cast<double>(row);
    const bool is_labelled = row == 0 || row == kPictureRows / 2 || row == kPictureRows - 1;
    rows[row] = RightAligned(is_labelled ? Fixed(level, 1) : "", kLabel) + " |";
    for (const Span& span : spans) {
      rows[row] += span.low <= level + step / 2 && span.high > level - step / 2 ? '*' : ' ';
    }
  }
  const std::string scale = "last " + NumberText(kSeconds) + " s";
  rows.back() = RightAligned(unit_, kLabel) + " |" + (scale.size() <= columns ? RightAligned(scale, columns) : "");
  return rows;
}

double LiveTrace::Rate() const {
  if (points_.size() < 2 || !(points_.back().time > points_.front().time)) return 0;
  return static_cast<double>(points_.size() - 1) / (points_.back().time - points_.front().time);
}

std::string LiveTrace::Level() const {
  constexpr std::size_t kWidth = 16;
  std::string bar(kWidth, ' ');
  const double share = std::clamp(counts_ / full_scale_, 0.0, 1.0);
  bar[static_cast<std::size_t>(share * (kWidth - 1))] = '*';
  const char* end = counts_ <= 0 ? " LOW" : counts_ >= full_scale_ ? " HIGH" : "";
  return "[" + bar + "]" + end;
}

std::string LiveTrace::StatusLine(std::string_view remark) const {
  if (points_.empty()) return "waiting for samples";
  return Fixed(points_.back().time, 1) + " s  " + NumberText(Rate(), 4) + " Hz  " + Fixed(points_.back().value, 1) +
         " " + unit_ + "  " + Level() + "  " + std::string(remark);
}

void RedrawnLines::Draw(const std::vector<std::string>& lines, std::size_t width) {
  std::string text = drawn_ > 0 ? "\x1b[" + std::to_string(drawn_) + "A" : "";
  for (const std::string& line : lines) text += line.substr(0, width - 1) + "\x1b[K\n";
  drawn_ = lines.size();
  WriteAll(descriptor_, text);
}

}  // namespace pendulum
