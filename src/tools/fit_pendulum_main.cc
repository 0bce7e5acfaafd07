// SPDX-License-Identifier: Apache-2.0
// Fits a pendulum's equation of motion to a recording of its free swing: flags, files and exit codes.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gflags/gflags.h>
#include <glog/logging.h>

#include "pendulum/fitting/fit.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/read_recording.h"
#include "pendulum/recording/window.h"
#include "pendulum/report/json.h"
#include "pendulum/report/series.h"
#include "pendulum/report/text.h"
#include "tools/fit_pendulum_options.h"
#include "tools/output.h"
#include "tools/run_tool.h"

const std::string kModelHelp = "Model of the motion, one of " + pendulum::MotionModelNames() + "; default coulomb.";

DEFINE_string(data, "",
              "Recording (CSV); its header names the columns and their units, such as time_s,angle_deg; - is "
              "standard input.");
DEFINE_string(calibration, "",
              "Calibration file (JSON) that turns counts or volts into an angle; default the file's own.");
DEFINE_string(time_column, "",
              "Column of times, name or number from 1 on, with :s, :ms or :us where the name tells no "
              "unit; none takes --sample_rate_hz instead; default by name.");
DEFINE_string(value_column, "",
              "Column of the angle or rate, name or number from 1 on; default by the unit in its name.");
DEFINE_string(unit, "",
              "Unit of the values: rad, deg, rad_s, deg_s, counts or volts; default that in the column's name.");
DEFINE_string(sample_rate_hz, "", "Samples per second of a file without times; default its line # sample_rate_hz.");
DEFINE_string(rig, "", "Rig file (JSON, SI units) that gives the gravity torque; without it torques are in its units.");
DEFINE_string(model, "coulomb", kModelHelp.c_str());
DEFINE_string(start, "auto", "How the recording begins: auto (the data tell), release or moving; default auto.");
DEFINE_string(from, "", "Start of the window to fit, s on the file's clock; default the first sample.");
DEFINE_string(to, "", "End of the window to fit, s on the file's clock; default the last sample.");
DEFINE_string(fix, "", "Parameters to hold, name=value,... in SI (rad, s; torques as in the report); default none.");
DEFINE_string(json, "", "Where to write the result as JSON; - is standard output; default nowhere.");
DEFINE_string(residuals, "", "Where to write the samples and residuals as CSV; - is standard output; default nowhere.");

namespace pendulum {
namespace {

constexpr std::string_view kName = "fit_pendulum";

constexpr const char* kUsage =
    "Moment of inertia and friction of a pendulum, with error bars, from a recording of its free swing.\n"
    "\n"
    "  fit_pendulum --data run.csv [--rig rig.json] [--model coulomb] [--json fit.json]\n"
    "\n"
    "Exit codes: 0 converged, 1 fitted but not converged or not identifiable, 2 wrong flags, 3 file not found,\n"
    "4 unreadable data, calibration or rig, 5 no swing in the data, 70 a bug, 73 an output cannot be written.\n"
    "\n";

FitPendulumFlags CurrentFlags(const std::vector<std::string>& positional) {
  FitPendulumFlags flags;
  flags.data = FLAGS_data;
  flags.rig = FLAGS_rig;
  flags.model = FLAGS_model;
  flags.start = FLAGS_start;
  flags.from = FLAGS_from;
  flags.to = FLAGS_to;
  flags.fix = FLAGS_fix;
  flags.json = FLAGS_json;
  flags.residuals = FLAGS_residuals;
  flags.calibration = FLAGS_calibration;
  flags.time_column = FLAGS_time_column;
  flags.value_column = FLAGS_value_column;
  flags.unit = FLAGS_unit;
  flags.sample_rate_hz = FLAGS_sample_rate_hz;
  flags.positional = positional;
  return flags;
}

/// Everything that is to be written, and how the fit ended.
struct RunResult {
  std::vector<Output> outputs;
  Termination termination = Termination::kFailed;
};

RunResult Render(const FitPendulumOptions& options, const RunReport& report, const Recording& used) {
  const FitReport& fit = report.fits.front();
  RunResult result;
  result.termination = fit.termination;
  if (!options.json.empty()) result.outputs.push_back({options.json, ToJsonText(report)});
  if (!options.residuals.empty()) result.outputs.push_back({options.residuals, ToResidualCsv(used, fit)});
  if (IsStandardOutput(options.json) || IsStandardOutput(options.residuals)) {
    for (const Warning& warning : AllWarnings(report)) Say(kName, "warning: " + warning.message);
  } else {
    result.outputs.push_back({"-", ToText(report)});
  }
  if (fit.termination != Termination::kConverged) {
    Say(kName, std::string(TerminationName(fit.termination)) + ": " + fit.reason);
  }
  return result;
}

/// The recording through its calibration.
Result<Recording> ReadData(FitPendulumOptions& options) {
  if (!options.calibration.empty()) {
    auto calibration = ReadCalibration(options.calibration);
    if (!calibration) return tl::unexpected(calibration.error());
    options.read.calibration = *std::move(calibration);
  }
  return ReadRecording(options.data, options.read);
}

/// The rig file, or without one what the recording says of its rig.
Result<std::optional<Rig>> ReadRigOf(const std::string& path, const Recording& recording) {
  if (path.empty() && recording.rig_json.empty()) return std::nullopt;
  auto rig = path.empty() ? ParseRig(recording.rig_json, recording.path + ": # rig") : ReadRig(path);
  if (!rig) return tl::unexpected(rig.error());
  return *std::move(rig);
}

Result<RunResult> FitFile(FitPendulumOptions options) {
  RunReport report;
  auto rig = ReadRigOf(options.rig, Recording());  // Its faults need no data.
  if (!rig) return tl::unexpected(rig.error());
  const auto recording = ReadData(options);
  if (!recording) return tl::unexpected(recording.error());
  if (!*rig) rig = ReadRigOf("", *recording);
  if (!rig) return tl::unexpected(rig.error());
  options.fit.rig = report.rig = *std::move(rig);
  const auto used = SelectWindow(*recording, options.from, options.to);
  if (!used) return tl::unexpected(used.error());
  auto fit = FitRecording(*used, options.fit);
  if (!fit) return tl::unexpected(fit.error());
  report.data = SummarizeData(*recording, *used);
  report.warnings = used->warnings;
  report.fits.push_back(*std::move(fit));
  return Render(options, report, *used);
}

Result<int> Work(const std::vector<std::string>& positional) {
  const auto options = MakeFitPendulumOptions(CurrentFlags(positional));
  if (!options) return tl::unexpected(options.error());
  if (const auto checked = CheckOutputs(options->Outputs(), options->Inputs()); !checked) {
    return tl::unexpected(checked.error());
  }
  const auto result = FitFile(*options);
  if (!result) return tl::unexpected(result.error());
  if (const auto written = WriteOutputs(result->outputs); !written) return tl::unexpected(written.error());
  return ExitCode(result->termination);
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres' remarks on trial steps are not the user's affair
  google::InitGoogleLogging(argv[0]);
  return pendulum::RunTool({pendulum::kName, __FILE__, pendulum::kUsage, pendulum::Work}, argc, argv);
}
