// SPDX-License-Identifier: Apache-2.0
#include "service/live_rows.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "pendulum/base/physics.h"
#include "pendulum/service/media_type.h"

namespace pendulum {
namespace {

/// The finite number in a field; std::nullopt for other content.
std::optional<double> NumberOf(std::string_view field) {
  field = WithoutBlanks(field);
  double number = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

/// The text before the first comma, and the text between the first and the second comma.
struct FirstColumns {
  std::string_view time, value;
};

FirstColumns FirstColumnsOf(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string_view::npos) return {line, {}};
  const std::string_view rest = line.substr(comma + 1);
  return {line.substr(0, comma), rest.substr(0, rest.find(','))};
}

/// "adc_counts" has the unit counts, "rate_rad_s" rad/s; a name without a unit has none.
std::string UnitOf(std::string_view column) {
  if (column.ends_with("_rad_s")) return "rad/s";
  if (column.ends_with("_deg_s")) return "deg/s";
  const std::size_t underscore = column.rfind('_');
  return std::string(underscore == std::string_view::npos ? "" : column.substr(underscore + 1));
}

}  // namespace

std::optional<LivePoint> LiveRows::Read(std::string_view line) {
  line = WithoutBlanks(line.substr(0, line.ends_with('\r') ? line.size() - 1 : line.size()));
  if (line.starts_with('#')) {
    if (!has_names_) ReadComment(WithoutBlanks(line.substr(1)));
    return std::nullopt;
  }
  if (line.empty()) return std::nullopt;
  if (!has_names_) {
    ReadNames(line);
    return std::nullopt;
  }
  const auto [time_text, value_text] = FirstColumnsOf(line);
  const auto time = NumberOf(time_text), value = NumberOf(value_text);
  if (!time || !value || (last_time_ && *time <= *last_time_)) return std::nullopt;
  const double shown = calibration_ ? calibration_->Angle(*value) / kRadFromDeg : *value;
  if (!std::isfinite(shown)) return std::nullopt;
  last_time_ = time;
  return LivePoint{*time, shown};
}

void LiveRows::ReadComment(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return;
  const std::string_view key = text.substr(0, colon), value = text.substr(colon + 1);
  if (key == "sample_rate_hz") rate_ = NumberOf(value);
  if (rate_ && *rate_ <= 0) rate_.reset();
  if (key != "calibration") return;
  if (auto calibration = ParseCalibration(WithoutBlanks(value), "calibration")) calibration_ = *std::move(calibration);
}

void LiveRows::ReadNames(std::string_view line) {
  has_names_ = true;
  unit_ = UnitOf(WithoutBlanks(FirstColumnsOf(line).value));
  if (calibration_ && calibration_->input != unit_) calibration_.reset();
  if (calibration_) unit_ = "deg";
}

}  // namespace pendulum
