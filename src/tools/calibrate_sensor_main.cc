// SPDX-License-Identifier: Apache-2.0
// Calibrates a sensor of angles from a table, or plans one: flags, files and exit codes.
#include <string>
#include <utility>
#include <vector>

#include <gflags/gflags.h>

#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/report/adc_plan_text.h"
#include "pendulum/report/calibration_plot.h"
#include "pendulum/report/calibration_text.h"
#include "pendulum/request/calibration_flags.h"
#include "tools/calibrate_sensor_options.h"
#include "tools/gnuplot.h"
#include "tools/output.h"
#include "tools/run_tool.h"

DEFINE_string(data, "", "Table with the columns counts or volts and angle_deg or angle_rad; - is standard input.");
DEFINE_int32(order, 1, "Highest power of the reading in the curve, 1 to 5; default 1, a straight line.");
DEFINE_string(input_range, "", "Range of the sensor, low,high, in the unit of the readings; default unknown.");
DEFINE_string(json, "", "Where to write the calibration for fit_pendulum; - is standard output; default nowhere.");
DEFINE_string(plot, "", "Where to write an SVG of curve and residuals (needs gnuplot); default nowhere.");
DEFINE_bool(plan, false, "Plans a potentiometer and converter instead, and prints their resolution. Default off.");
DEFINE_int32(bits, 0, "Of the converter, 1 to 32; default 10 in a plan. With --data the range is 0 to 2^bits - 1.");
DEFINE_string(reference_voltage, "", "In a plan: references of the converter in V, between commas; default 5.");
DEFINE_double(supply_voltage, 5, "In a plan: V across the potentiometer; default 5.");
DEFINE_double(potentiometer_range_deg, 270, "In a plan: electrical travel of the potentiometer, deg; default 270.");
DEFINE_double(divider, 1, "In a plan: V at the converter for 1 V at the wiper, R2/(R1+R2); default 1, no divider.");

namespace pendulum {
namespace {

constexpr std::string_view kName = "calibrate_sensor";

constexpr const char* kUsage =
    "Turns a table of readings at known angles into the calibration that fit_pendulum reads, or plans a sensor.\n"
    "\n"
    "  calibrate_sensor --data table.csv --json cal.json --plot cal.svg\n"
    "  calibrate_sensor --plan --reference_voltage 5,3.3,1.1 --potentiometer_range_deg 270\n"
    "\n"
    "Exit codes: 0 done, 2 wrong flags, 3 file not found, 4 a table that cannot be read or calibrated, 70 a bug, 73 "
    "an\n"
    "output cannot be written.\n"
    "\n";

CalibrateSensorFlags CurrentFlags(const std::vector<std::string>& positional) {
  CalibrateSensorFlags flags;
  flags.data = FLAGS_data;
  flags.order = FLAGS_order;
  flags.input_range = FLAGS_input_range;
  flags.json = FLAGS_json;
  flags.plot = FLAGS_plot;
  flags.plan = FLAGS_plan;
  flags.bits = FLAGS_bits;
  flags.reference_voltage = FLAGS_reference_voltage;
  flags.supply_voltage = FLAGS_supply_voltage;
  flags.potentiometer_range_deg = FLAGS_potentiometer_range_deg;
  flags.divider = FLAGS_divider;
  flags.positional = positional;
  return flags;
}

Result<void> CheckBeforeWork(const CalibrateSensorOptions& options) {
  if (auto checked = CheckOutputs(options.Outputs(), options.Inputs()); !checked) return checked;
  return options.plot.empty() ? Result<void>() : CheckGnuplot();
}

Result<std::vector<Output>> MakeOutputs(const CalibrateSensorOptions& options) {
  if (!options.plan.empty()) return std::vector<Output>{{"-", AdcPlanText(options.plan)}};
  const Result<CalibrationTable> table = ReadCalibrationTable(options.data);
  if (!table) return tl::unexpected(table.error());
  const Result<CalibrationFit> fit = CalibrateTable(*table, options);
  if (!fit) return tl::unexpected(fit.error());
  std::vector<Output> outputs;
  if (!options.json.empty()) outputs.push_back({options.json, fit->calibration.source.dump(2) + "\n"});
  if (!options.plot.empty()) {
    Result<std::string> plot = RunGnuplot(CalibrationPlot(*table, *fit));
    if (!plot) return tl::unexpected(plot.error());
    outputs.push_back({options.plot, *std::move(plot)});
  }
  if (!IsStandardOutput(options.json) && !IsStandardOutput(options.plot)) {
    outputs.push_back({"-", CalibrationText(*table, *fit)});
  }
  return outputs;
}

Result<int> Work(const std::vector<std::string>& positional) {
  const auto options = MakeCalibrateSensorOptions(CurrentFlags(positional));
  if (!options) return tl::unexpected(options.error());
  if (const auto checked = CheckBeforeWork(*options); !checked) return tl::unexpected(checked.error());
  const auto outputs = MakeOutputs(*options);
  if (!outputs) return tl::unexpected(outputs.error());
  return WriteOutputs(*outputs).map([] { return 0; });
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool({pendulum::kName, __FILE__, pendulum::kUsage, pendulum::Work}, argc, argv);
}
