// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/calibration_flags.h"

#include <string>
#include <vector>

#include "pendulum/base/try.h"
#include "pendulum/recording/calibration/adc.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

Result<void> CheckWhole(const std::string& flag, int value, int max_value) {
  if (value >= 1 && value <= max_value) return {};
  return BadFlag(flag + " is " + std::to_string(value) + "; it must be 1 to " + std::to_string(max_value));
}

Result<SensorRange> ParseInputRange(const std::string& text) {
  const std::vector<std::string> ends = Split(text, ',');
  if (ends.size() != 2 || text.ends_with(',')) return BadFlag("--input_range is '" + text + "'; it must be low,high");
  const Result<double> low = ParseNumber("--input_range", ends[0], "two numbers: low,high");
  const Result<double> high = ParseNumber("--input_range", ends[1], "two numbers: low,high");
  if (!low) return tl::unexpected(low.error());
  if (!high) return tl::unexpected(high.error());
  if (*low >= *high) return BadFlag("--input_range is '" + text + "'; low must be less than high");
  return SensorRange{*low, *high};
}

Result<void> ChooseRange(const CalibrationFlags& flags, CalibrationOptions& options) {
  options.has_bits = flags.bits != 0;
  if (options.has_bits && !flags.input_range.empty()) {
    return BadFlag("--bits and --input_range both define the sensor's range; leave one of them out");
  }
  if (options.has_bits) options.input_range = SensorRange{0, AdcSensor{.bits = flags.bits}.FullScale()};
  if (flags.input_range.empty()) return {};
  ASSIGN_OR_RETURN(const SensorRange range, ParseInputRange(flags.input_range));
  options.input_range = range;
  return {};
}

}  // namespace

Result<void> CheckBits(int bits) {
  constexpr int kMaxBits = 32;
  return bits == 0 ? Result<void>() : CheckWhole("--bits", bits, kMaxBits);
}

Result<CalibrationOptions> MakeCalibrationOptions(const CalibrationFlags& flags) {
  RETURN_IF_ERROR(CheckBits(flags.bits));
  RETURN_IF_ERROR(CheckWhole("--order", flags.order, kHighestCalibrationOrder));
  CalibrationOptions options;
  RETURN_IF_ERROR(ChooseRange(flags, options));
  options.order = flags.order;
  return options;
}

Result<CalibrationFit> CalibrateTable(const CalibrationTable& table, const CalibrationOptions& options) {
  if (options.has_bits && table.input != "counts") {
    return Error(StatusCode::kInvalidArgument,
                 "--bits defines the range of counts, but " + table.path + " has volts; give --input_range");
  }
  return CalibrateSensor(table, options.order, options.input_range);
}

}  // namespace pendulum
