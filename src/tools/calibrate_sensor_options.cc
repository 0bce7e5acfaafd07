// SPDX-License-Identifier: Apache-2.0
#include "tools/calibrate_sensor_options.h"

#include <array>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

constexpr int kUsualBits = 10;  // bits of the ATmega328P's converter

/// Checks a quantity against limits that no sensible value exceeds and no computation overflows with.
Result<void> CheckQuantity(const std::string& flag, double value, double max_value) {
  if (value >= 1e-6 && value <= max_value) return {};
  return BadFlag(flag + " is " + NumberText(value) + "; it must be positive, 0.000001 to " + NumberText(max_value));
}

/// Refuses a flag that has no effect on the requested task.
Result<void> CheckBelongs(bool is_given, const std::string& flag, bool plan) {
  if (!is_given) return {};
  return BadFlag(flag + (plan ? " belongs to the calibration of a table; leave it or --plan out"
                              : " belongs to a plan; add --plan, or leave it out"));
}

/// The path of the table, named without a flag or with --data.
std::string TableOf(const CalibrateSensorFlags& flags) {
  return flags.positional.empty() ? flags.data : flags.positional.front();
}

Result<void> CheckTask(const CalibrateSensorFlags& flags) {
  if (flags.positional.size() > (flags.plan || !flags.data.empty() ? 0U : 1U)) {
    return BadFlag("'" + flags.positional.back() + "' does not belong to a flag" +
                   (flags.plan ? "" : "; give one table, without a flag or with --data"));
  }
  if (!flags.plan && TableOf(flags).empty()) {
    return BadFlag(
        "no table was given: a file with counts or volts and angles, as in calibrate_sensor table.csv, or - for "
        "standard input; --plan needs none");
  }
  const CalibrateSensorFlags unset;
  const std::array<std::pair<bool, const char*>, 6> of_a_table = {{{!flags.data.empty(), "--data"},
                                                                   {flags.order != unset.order, "--order"},
                                                                   {!flags.input_range.empty(), "--input_range"},
                                                                   {!flags.json.empty(), "--json"},
                                                                   {!flags.plot.empty(), "--plot"},
                                                                   {flags.details, "--details"}}};
  const std::array<std::pair<bool, const char*>, 4> of_a_plan = {
      {{!flags.reference_voltage.empty(), "--reference_voltage"},
       {flags.supply_voltage != unset.supply_voltage, "--supply_voltage"},
       {flags.potentiometer_range_deg != unset.potentiometer_range_deg, "--potentiometer_range_deg"},
       {flags.divider != unset.divider, "--divider"}}};
  for (const auto& [is_given, flag] : of_a_table) {
    RETURN_IF_ERROR(CheckBelongs(flags.plan && is_given, flag, true));
  }
  for (const auto& [is_given, flag] : of_a_plan) {
    RETURN_IF_ERROR(CheckBelongs(!flags.plan && is_given, flag, false));
  }
  return CheckBits(flags.bits);
}

Result<std::vector<AdcSensor>> MakePlan(const CalibrateSensorFlags& flags) {
  constexpr double kMaxVolts = 1000, kMaxDeg = 36000;
  RETURN_IF_ERROR(CheckQuantity("--supply_voltage", flags.supply_voltage, kMaxVolts));
  RETURN_IF_ERROR(CheckQuantity("--potentiometer_range_deg", flags.potentiometer_range_deg, kMaxDeg));
  RETURN_IF_ERROR(CheckQuantity("--divider", flags.divider, 1));
  const std::string list = flags.reference_voltage.empty() ? "5" : flags.reference_voltage;
  if (list.ends_with(',')) return BadFlag("--reference_voltage is '" + list + "', which ends with a comma");
  std::vector<AdcSensor> plan;
  for (const std::string& text : Split(list, ',')) {
    ASSIGN_OR_RETURN(const auto volts,
                     ParseNumber("--reference_voltage", text, "a number of volts, or several between commas"));
    RETURN_IF_ERROR(CheckQuantity("--reference_voltage", volts, kMaxVolts));
    plan.push_back({flags.bits == 0 ? kUsualBits : flags.bits, volts, flags.supply_voltage,
                    flags.potentiometer_range_deg, flags.divider});
  }
  return plan;
}

}  // namespace

std::vector<NamedFile> CalibrateSensorOptions::Outputs() const {
  std::vector<NamedFile> outputs;
  if (!json.empty()) outputs.push_back({"--json", json});
  if (!plot.empty()) outputs.push_back({"--plot", plot});
  return outputs;
}

std::vector<NamedFile> CalibrateSensorOptions::Inputs() const {
  if (data.empty() || data == "-") return {};
  return {{"--data", data}};
}

Result<CalibrateSensorOptions> MakeCalibrateSensorOptions(const CalibrateSensorFlags& flags) {
  RETURN_IF_ERROR(CheckTask(flags));
  CalibrateSensorOptions options;
  options.details = flags.details;
  if (flags.plan) {
    ASSIGN_OR_RETURN(std::vector<AdcSensor> plan, MakePlan(flags));
    options.plan = std::move(plan);
    return options;
  }
  ASSIGN_OR_RETURN(const CalibrationOptions calibration, MakeCalibrationOptions(flags));
  static_cast<CalibrationOptions&>(options) = calibration;
  options.data = TableOf(flags);
  options.json = flags.json;
  options.plot = flags.plot;
  return options;
}

}  // namespace pendulum
