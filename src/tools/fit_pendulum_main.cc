// SPDX-License-Identifier: Apache-2.0
// Fits a pendulum's equation of motion to a recording of its free swing: flags, files and exit codes.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gflags/gflags.h>

#include "pendulum/fitting/fit_swing.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/data_list.h"
#include "pendulum/recording/read_recording.h"
#include "pendulum/recording/repair_values.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/report/json.h"
#include "pendulum/report/series.h"
#include "pendulum/report/text.h"
#include "tools/fit_pendulum_options.h"
#include "tools/output.h"
#include "tools/run_tool.h"

const std::string kModelHelp = "Model of the motion, one of " + pendulum::MotionModelNames() + "; default coulomb.";

DEFINE_string(data, "",
              "Recording (CSV), or several between commas; the header names the columns and their units, such as "
              "time_s,angle_deg; - is standard input.");
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
DEFINE_string(data_list, "", "File that lists recordings, one path a line, each to be fitted by itself; default none.");
DEFINE_string(release, "", "Which free swing of a recording to fit: a number from 1, or all; default the longest.");
DEFINE_string(rig, "", "Rig file (JSON, SI units) that gives the gravity torque; without it torques are in its units.");
DEFINE_string(model, "coulomb", kModelHelp.c_str());
DEFINE_string(start, "auto", "How the recording begins: auto (the data tell), release or moving; default auto.");
DEFINE_string(from, "", "Start of the window to fit, s on the file's clock; default where the free swing begins.");
DEFINE_string(to, "", "End of the window to fit, s on the file's clock; default where the free swing ends.");
DEFINE_string(fix, "", "Parameters to hold, name=value,... in SI (rad, s; torques as in the report); default none.");
DEFINE_string(init, "", "Where parameters begin, name=value,... as in --fix; default where the data say.");
DEFINE_string(bounds, "", "Bounds of parameters, name=low:high,... as in --fix, either may be left out; default none.");
DEFINE_string(prior, "", "What is known beforehand, name=mean:std_dev,... as in --fix; default nothing.");
DEFINE_string(resolution, "",
              "Spacing of the sensor's levels, in the file's unit; 0 is none; default the file's, or found in it.");
DEFINE_string(range, "", "What the sensor can show, low,high in the file's unit; readings there are censored.");
DEFINE_string(noise, "auto",
              "Noise of the readings: gaussian, quantized (rounded to levels) or auto (quantized where rounding "
              "matters); default auto.");
DEFINE_string(loss, "none", "Robust alternative for recordings with outliers: huber, student or none; default none.");
DEFINE_string(interval, "auto",
              "95 % intervals by covariance, profile, bootstrap or auto (profile near a bound); default auto.");
DEFINE_string(seed, "", "Seed of the bootstrap and of posterior draws; default 1.");
DEFINE_string(threads, "", "Threads of the bootstrap, 0 for all cores; the result does not depend on it; default 0.");
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
    "Of several fits those that can be made are written, and the largest code counts.\n"
    "\n";

FitPendulumFlags CurrentFlags(const std::vector<std::string>& positional) {
  FitPendulumFlags flags;
  flags.data = FLAGS_data;
  flags.data_list = FLAGS_data_list;
  flags.release = FLAGS_release;
  flags.init = FLAGS_init;
  flags.bounds = FLAGS_bounds;
  flags.prior = FLAGS_prior;
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
  flags.resolution = FLAGS_resolution;
  flags.range = FLAGS_range;
  flags.noise = FLAGS_noise;
  flags.loss = FLAGS_loss;
  flags.interval = FLAGS_interval;
  flags.seed = FLAGS_seed;
  flags.threads = FLAGS_threads;
  flags.positional = positional;
  return flags;
}

/// One free swing of one recording, fitted.
struct Run {
  RunReport report;
  Recording used;
};

/// What the runs need beside their flags.
struct Setup {
  std::vector<std::string> paths;  ///< Of the recordings.
  std::vector<NamedFile> inputs;   ///< All that is read.
  std::optional<Rig> rig;
};

Result<Setup> ReadSetup(FitPendulumOptions& options) {
  Setup setup{options.data, options.Inputs(), std::nullopt};
  if (!options.rig.empty()) {
    auto rig = ReadRig(options.rig);
    if (!rig) return tl::unexpected(rig.error());
    setup.rig = *std::move(rig);
  }
  if (!options.calibration.empty()) {
    auto calibration = ReadCalibration(options.calibration);
    if (!calibration) return tl::unexpected(calibration.error());
    options.read.calibration = *std::move(calibration);
  }
  if (options.data_list.empty()) return setup;
  const auto listed = ReadDataList(options.data_list);
  if (!listed) return tl::unexpected(listed.error());
  for (const ListedFile& file : *listed) {
    setup.paths.push_back(file.path.string());
    setup.inputs.push_back({"--data_list", file.path.string()});
  }
  return setup;
}

/// Numbered outputs are other files than those that were named; data of several fits have no place on one stream.
Result<void> CheckNumberedOutputs(const FitPendulumOptions& options, const Setup& setup, std::size_t count) {
  if (count == 1) return {};
  for (const NamedFile& output : options.Outputs()) {
    if (!IsStandardOutput(output.path)) continue;
    return Error(StatusCode::kInvalidArgument, output.flag + " " + output.path + " takes one fit, and there are " +
                                                   std::to_string(count) + "; name a file, and they are numbered");
  }
  std::vector<NamedFile> outputs;
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::move(options.Outputs(static_cast<int>(i), static_cast<int>(count)), std::back_inserter(outputs));
  }
  return CheckOutputs(outputs, setup.inputs);
}

/// A recording that was read, and the swings to be fitted in it.
struct ReadSwings {
  Recording recording;
  ChosenSwings swings;
  Eigen::Index samples = 0;  ///< As read, before repairs.
  RunReport common;          ///< What the reports of all its swings say.
};

/// `rig` wins over what the recording says of its rig.
Result<ReadSwings> ReadOne(const FitPendulumOptions& options, const std::string& path, std::optional<Rig> rig) {
  auto read = ReadRecording(path, options.read);
  if (!read) return tl::unexpected(read.error());
  if (!rig && !read->rig_json.empty()) {
    auto own = ParseRig(read->rig_json, read->path + ": # rig");
    if (!own) return tl::unexpected(own.error());
    rig = *std::move(own);
  }
  ReadSwings one;
  one.samples = read->size();
  one.recording = RepairValues(*std::move(read));
  auto swings = ChooseSwings(one.recording, options.swing);
  if (!swings) return tl::unexpected(swings.error());
  one.swings = *std::move(swings);
  one.common.rig = std::move(rig);
  one.common.warnings = std::exchange(one.recording.warnings, {});
  if (one.recording.calibration) one.common.calibration = one.recording.calibration->source;
  return one;
}

/// The error of one among several runs, which names its recording and, unless 0, its release.
tl::unexpected<Status> ErrorAmong(const Status& status, const std::string& path, int release) {
  const std::string name = path == "-" ? "standard input" : path;
  if (release == 0 && status.message.starts_with(name + ":")) return tl::unexpected(status);
  const std::string where = name + ": ";
  const std::size_t skip = status.message.starts_with(where) ? where.size() : 0;
  return Error(status.code, where + (release == 0 ? "" : "free swing " + std::to_string(release) + ": ") +
                                status.message.substr(skip));
}

/// Now and then how far the bootstrap is.
void SayProgress(int done, int total) {
  Say(kName, "bootstrap: " + std::to_string(done) + " of " + std::to_string(total) + " fits");
}

/// Fits the chosen swings of one recording one by one and appends their runs.
void FitOne(const FitPendulumOptions& options, const std::string& path, ReadSwings one, bool among_others,
            std::vector<Result<Run>>& runs) {
  FitOptions fit_options = options.fit;
  fit_options.progress = SayProgress;
  fit_options.rig = one.common.rig;
  const bool several = one.swings.chosen.size() > 1;
  for (const int release : one.swings.chosen) {
    // The last one needs no copy: a long recording fills the memory.
    const bool last = release == one.swings.chosen.back();
    auto fit = FitSwing(last ? std::exchange(one.recording, {}) : one.recording,
                        one.swings.found[static_cast<std::size_t>(release - 1)], fit_options);
    if (!fit) {
      runs.emplace_back(among_others || several ? ErrorAmong(fit.error(), path, several ? release : 0)
                                                : tl::unexpected(fit.error()));
      continue;
    }
    Run run{one.common, {}};
    run.report.data = SummarizeData(*fit, one.swings, release, one.samples);
    run.report.fits.push_back(std::move(fit->fit));
    run.used = std::move(fit->used);
    runs.emplace_back(std::move(run));
  }
}

/// The runs of all recordings, in their order: one that cannot be fitted keeps its place, and the others go on.
///
/// kInvalidArgument, kCannotWrite: outputs that are one too many once the releases are counted.
Result<std::vector<Result<Run>>> FitAll(const FitPendulumOptions& options, const Setup& setup) {
  std::vector<Result<Run>> runs;
  const std::size_t files = setup.paths.size();
  std::size_t count = files;  // of places: at least one for each recording
  for (const std::string& path : setup.paths) {
    auto one = ReadOne(options, path, setup.rig);
    if (!one) {
      runs.emplace_back(files > 1 ? ErrorAmong(one.error(), path, 0) : tl::unexpected(one.error()));
      continue;
    }
    if (const std::size_t more = one->swings.chosen.size() - 1; more > 0) {
      count += more;
      if (const auto checked = CheckNumberedOutputs(options, setup, count); !checked) {
        return tl::unexpected(checked.error());
      }
    }
    FitOne(options, path, *std::move(one), files > 1, runs);
  }
  return runs;
}

/// What is to be written of all runs; tables for people are joined on standard output unless data go there. What could
/// not be fitted is said.
std::vector<Output> Render(const FitPendulumOptions& options, const std::vector<Result<Run>>& runs) {
  const bool data_on_stdout = IsStandardOutput(options.json) || IsStandardOutput(options.residuals);
  const auto count = static_cast<int>(runs.size());
  std::vector<Output> outputs;
  std::string text;
  for (int i = 0; i < count; ++i) {
    const Result<Run>& run = runs[static_cast<std::size_t>(i)];
    if (!run) {
      Say(kName, run.error().message);
      continue;
    }
    const FitReport& fit = run->report.fits.front();
    if (!options.json.empty()) {
      outputs.push_back({NumberedPath(options.json, i, count), ToJsonText(run->report)});
    }
    if (!options.residuals.empty()) {
      outputs.push_back({NumberedPath(options.residuals, i, count), ToResidualCsv(run->used, fit)});
    }
    text += (text.empty() ? "" : "\n") + ToText(run->report);
    if (data_on_stdout) {
      for (const Warning& warning : AllWarnings(run->report)) Say(kName, "warning: " + warning.message);
    }
    if (fit.termination != Termination::kConverged) {
      Say(kName, std::string(TerminationName(fit.termination)) + ": " + fit.reason);
    }
  }
  if (!data_on_stdout && !text.empty()) outputs.push_back({"-", text});
  return outputs;
}

Result<int> Work(const std::vector<std::string>& positional) {
  auto options = MakeFitPendulumOptions(CurrentFlags(positional));
  if (!options) return tl::unexpected(options.error());
  const auto setup = ReadSetup(*options);
  if (!setup) return tl::unexpected(setup.error());
  auto checked = CheckOutputs(options->Outputs(), setup->inputs);
  if (checked) checked = CheckNumberedOutputs(*options, *setup, setup->paths.size());
  if (!checked) return tl::unexpected(checked.error());
  const auto runs = FitAll(*options, *setup);
  if (!runs) return tl::unexpected(runs.error());
  if (const auto written = WriteOutputs(Render(*options, *runs)); !written) return tl::unexpected(written.error());
  int worst = 0;
  for (const Result<Run>& run : *runs) {
    worst = std::max(worst, run ? ExitCode(run->report.fits.front().termination) : ExitCode(run.error().code));
  }
  return worst;
}

}  // namespace
}  // namespace pendulum

int main(int argc, char** argv) {
  return pendulum::RunTool({pendulum::kName, __FILE__, pendulum::kUsage, pendulum::Work}, argc, argv);
}
