// SPDX-License-Identifier: Apache-2.0
// Calibrates an angle sensor from a table of points, or plans a sensor: flags, files and exit codes.
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/try.h"
#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/report/adc_plan_text.h"
#include "pendulum/report/calibration_plot.h"
#include "pendulum/report/calibration_text.h"
#include "pendulum/request/calibration_flags.h"
#include "tools/calibrate_sensor_options.h"
#include "tools/gnuplot.h"
#include "tools/output.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

constexpr std::string_view kName = "calibrate_sensor";

constexpr const char* kUsage =
    "Turns a table of readings at known angles into the calibration that fit_pendulum reads, or plans a sensor.\n"
    "\n"
    "  calibrate_sensor table.csv\n"
    "  calibrate_sensor table.csv --order 2 --json cal.json --plot cal.svg\n"
    "  calibrate_sensor --plan --reference_voltage 5,3.3,1.1 --potentiometer_range_deg 270\n"
    "\n"
    "Exit codes: 0 done, 2 wrong flags, 3 file not found, 4 a table that cannot be read or calibrated, 70 a bug, 73 "
    "an\n"
    "output cannot be written.\n"
    "\n";

using Flags = CalibrateSensorFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  return {
      {"data", &Flags::data,
       "Table, which may also be named without a flag, with the columns counts or volts and angle_deg or angle_rad; - "
       "is standard input."},
      {"order", &Flags::order, "Highest power of the reading in the curve, 1 to 5; default 1, a straight line."},
      {"input_range", &Flags::input_range,
       "Range of the sensor, low,high, in the unit of the readings; default unknown."},
      {"json", &Flags::json, "Where to write the calibration for fit_pendulum; - is standard output; default nowhere."},
      {"plot", &Flags::plot, "Where to write an SVG plot of curve and residuals (needs gnuplot); default nowhere."},
      {"details", &Flags::details, "Prints points, residuals and correlations, too; default: the summary alone."},
      {"plan", &Flags::plan,
       "Instead of calibrating, plans a potentiometer and a converter and prints their resolution. Default off."},
      {"bits", &Flags::bits,
       "Bits of the converter, 1 to 32; default 10 in a plan. With --data, the range is 0 to 2^bits - 1."},
      {"reference_voltage", &Flags::reference_voltage,
       "In a plan: reference voltages of the converter in V, separated by commas; default 5."},
      {"supply_voltage", &Flags::supply_voltage, "In a plan: voltage across the potentiometer in V; default 5."},
      {"potentiometer_range_deg", &Flags::potentiometer_range_deg,
       "In a plan: electrical travel of the potentiometer, deg; default 270."},
      {"divider", &Flags::divider,
       "In a plan: voltage at the converter in V for 1 V at the wiper, R2/(R1+R2); default 1, no divider."},
  };
}

Result<void> CheckBeforeWork(const CalibrateSensorOptions& options) {
  RETURN_IF_ERROR(CheckOutputs(options.Outputs(), options.Inputs()));
  return options.plot.empty() ? Result<void>() : CheckGnuplot();
}

Result<std::vector<Output>> MakeOutputs(const CalibrateSensorOptions& options) {
  if (!options.plan.empty()) return std::vector<Output>{{"-", AdcPlanText(options.plan)}};
  ASSIGN_OR_RETURN(const CalibrationTable table, ReadCalibrationTable(options.data));
  ASSIGN_OR_RETURN(const CalibrationFit fit, CalibrateTable(table, options));
  std::vector<Output> outputs;
  if (!options.json.empty()) outputs.push_back({options.json, fit.calibration.source.dump(2) + "\n"});
  if (!options.plot.empty()) {
    ASSIGN_OR_RETURN(std::string plot, RunGnuplot(CalibrationPlot(table, fit)));
    outputs.push_back({options.plot, std::move(plot)});
  }
  if (!IsStandardOutput(options.json) && !IsStandardOutput(options.plot)) {
    outputs.push_back({"-", CalibrationText(table, fit, options.details ? TextExtent::kAll : TextExtent::kSummary)});
  }
  return outputs;
}

Result<int> Work(const Flags& flags) {
  ASSIGN_OR_RETURN(const auto options, MakeCalibrateSensorOptions(flags));
  RETURN_IF_ERROR(CheckBeforeWork(options));
  ASSIGN_OR_RETURN(const auto outputs, MakeOutputs(options));
  return WriteOutputs(outputs).map([] { return 0; });
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool(pendulum::kName, __FILE__, pendulum::kUsage, pendulum::FlagTable(), pendulum::Work, argc,
                           argv);
}
