// SPDX-License-Identifier: Apache-2.0
// Fits a pendulum's equation of motion to a recording of its free swing: flags, files and exit codes.
#include <string>
#include <string_view>
#include <vector>

#include <gflags/gflags.h>
#include <glog/logging.h>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit.h"
#include "pendulum/fitting/fit_swing.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/read_recording.h"
#include "pendulum/recording/repair_values.h"
#include "pendulum/report/json.h"
#include "pendulum/report/series.h"
#include "pendulum/report/text.h"
#include "tools/fit_pendulum_options.h"
#include "tools/output.h"
#include "tools/run_tool.h"

const std::string kModelHelp = "Model of the motion, one of " + pendulum::MotionModelNames() + "; default coulomb.";

DEFINE_string(data, "", "Recording (CSV); its header names the columns and their units, such as time_s,angle_deg.");
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
    "4 unreadable data or rig, 5 no swing in the data, 70 a bug, 73 an output cannot be written.\n"
    "\n";

FitPendulumFlags CurrentFlags(const std::vector<std::string>& positional) {
  return {FLAGS_data, FLAGS_rig, FLAGS_model, FLAGS_start,     FLAGS_from,
          FLAGS_to,   FLAGS_fix, FLAGS_json,  FLAGS_residuals, positional};
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

Result<RunResult> FitFile(FitPendulumOptions options) {
  RunReport report;
  if (!options.rig.empty()) {
    auto rig = ReadRig(options.rig);
    if (!rig) return tl::unexpected(rig.error());
    report.rig = *std::move(rig);
    options.fit.rig = report.rig;
  }
  const auto recording = ReadRecording(options.data);
  if (!recording) return tl::unexpected(recording.error());
  const Recording repaired = RepairValues(*recording);
  const auto swings = ChooseSwings(repaired, options.swing);
  if (!swings) return tl::unexpected(swings.error());
  auto fit = FitSwing(repaired, swings->found[swings->chosen.front() - 1], options.fit);
  if (!fit) return tl::unexpected(fit.error());
  report.data = SummarizeData(*recording, fit->used);
  report.warnings = repaired.warnings;
  report.fits.push_back(fit->fit);
  return Render(options, report, fit->used);
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
