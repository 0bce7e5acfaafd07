// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_pendulum_options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "pendulum/analysis/fit_models.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/report/fit_plot.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

bool IsStandardInput(const std::string& path) { return path == "-" || path == "/dev/stdin" || path == "/dev/fd/0"; }

/// The recordings named without a flag or with --data.
std::vector<std::string> RecordingPaths(const FitPendulumFlags& flags) {
  return flags.positional.empty() ? Split(flags.data, ',') : flags.positional;
}

Result<void> CheckData(const FitPendulumFlags& flags) {
  const std::string list = flags.data.empty() ? "--data_list" : "--data";
  if (!flags.positional.empty() && !(flags.data.empty() && flags.data_list.empty())) {
    return BadFlag("'" + flags.positional.front() + "' and " + list +
                   " both name recordings; give all of them without a flag, or all with " + list);
  }
  if (!flags.data.empty() && !flags.data_list.empty()) {
    return BadFlag("--data and --data_list both name recordings; give one of them");
  }
  if (flags.positional.empty() && flags.data.empty() && flags.data_list.empty()) {
    return BadFlag("no recording was given; name its file, as in fit_pendulum run.csv; --help shows examples");
  }
  const std::vector<std::string> paths = RecordingPaths(flags);
  for (const std::string& path : paths) {
    if (path.empty()) return BadFlag("--data '" + flags.data + "' has an empty name between its commas");
  }
  if (std::ranges::count_if(paths, IsStandardInput) > 1) {
    return BadFlag((flags.data.empty() ? "standard input is named twice"
                                       : "--data '" + flags.data + "' names standard input twice") +
                   std::string(", but it can be read only once"));
  }
  return {};
}

/// Refuses outputs that closed forms alone cannot provide.
Result<void> CheckClosedFormOnly(const FitPendulumFlags& flags) {
  if (!flags.closed_form_only) return {};
  if (!flags.shared.empty() && flags.shared != "none") return NeedsFitError("--shared");
  if (!flags.residuals.empty()) return NeedsFitError("--residuals");
  if (!flags.plot.empty()) return NeedsFitError("--plot");
  if (flags.terminal_plot) return NeedsFitError("--terminal_plot");
  return {};
}

Result<void> CheckPlot(const FitPendulumFlags& flags) {
  if (flags.plot.empty() || PictureFormatOf(flags.plot)) return {};
  return BadFlag("--plot '" + flags.plot + "' must end in .svg, .png or .pdf, which says what the picture is");
}

/// Parses the parameters that recordings share; the default is all of inertia and friction.
Result<void> ParseShared(const FitPendulumFlags& flags, FitPendulumOptions& options) {
  const std::vector<std::string> all = PhysicalNames(options.models);
  options.shared = all;
  if (flags.shared.empty()) return {};
  options.sharing = flags.shared == "none" ? Sharing::kNothing : Sharing::kAsked;
  if (flags.shared == "none" || flags.shared == "all") return {};
  options.shared = Split(flags.shared, ',');
  for (const std::string& name : options.shared) {
    if (std::ranges::find(all, name) == all.end()) {
      return BadFlag("--shared names '" + name + "', which recordings cannot share; they can share " + NameList(all) +
                     ", or all, or none");
    }
    if (std::ranges::count(options.shared, name) > 1) return BadFlag("--shared names " + name + " twice");
  }
  return {};
}

Result<void> CheckText(const FitPendulumFlags& flags) {
  if (!flags.details || !flags.quiet) return {};
  return BadFlag("--details and --quiet contradict each other; give one of them");
}

/// A joint fit has intervals from its covariance or from profiles only.
Result<void> CheckJoint(const FitPendulumFlags& flags, const FitPendulumOptions& options) {
  const bool joint = options.IsJoint(options.data.size()) || (!flags.data_list.empty() && options.IsJoint(2));
  if (!joint || options.fit.interval != IntervalMethod::kBootstrap) return {};
  return BadFlag(
      "--interval bootstrap is only for separate fits (--shared none); for a joint fit use covariance or profile");
}

}  // namespace

std::vector<NamedFile> FitPendulumOptions::Outputs(int index, int count) const {
  std::vector<NamedFile> outputs;
  if (!json.empty()) outputs.push_back({"--json", NumberedPath(json, index, count)});
  if (!residuals.empty()) outputs.push_back({"--residuals", NumberedPath(residuals, index, count)});
  if (!plot.empty()) outputs.push_back({"--plot", NumberedPath(plot, index, count)});
  if (!series.empty()) outputs.push_back({"--series", NumberedPath(series, index, count)});
  if (!report.empty()) outputs.push_back({"--report", NumberedPath(report, index, count)});
  if (!markdown.empty()) outputs.push_back({"--markdown", NumberedPath(markdown, index, count)});
  return outputs;
}

std::vector<NamedFile> FitPendulumOptions::JointOutputs(int recordings) const {
  std::vector<NamedFile> outputs = Outputs();
  std::erase_if(outputs,
                [](const NamedFile& output) { return output.flag == "--residuals" || output.flag == "--plot"; });
  for (int k = 0; k < recordings; ++k) {
    if (!residuals.empty()) outputs.push_back({"--residuals", NumberedPath(residuals, k, recordings)});
    if (!plot.empty()) outputs.push_back({"--plot", NumberedPath(plot, k, recordings)});
  }
  return outputs;
}

bool FitPendulumOptions::IsJoint(std::size_t recordings) const {
  if (closed_form_only || sharing == Sharing::kNothing) return false;
  return recordings > 1 || sharing == Sharing::kAsked;
}

std::vector<NamedFile> FitPendulumOptions::Inputs() const {
  std::vector<NamedFile> inputs;
  for (const std::string& path : data) {
    if (path != "-") inputs.push_back({"--data", path});
  }
  if (!data_list.empty() && data_list != "-") inputs.push_back({"--data_list", data_list});
  if (!calibration.empty()) inputs.push_back({"--calibration", calibration});
  if (!sensor_path.empty()) inputs.push_back({"--sensor", sensor_path});
  if (!rig.empty()) inputs.push_back({"--rig", rig});
  return inputs;
}

Result<FitPendulumOptions> MakeFitPendulumOptions(const FitPendulumFlags& given) {
  FitPendulumFlags flags = given;
  FitPendulumOptions options;
  RETURN_IF_ERROR(CheckData(flags));
  RETURN_IF_ERROR(CheckText(flags));
  RETURN_IF_ERROR(CheckPlot(flags));
  RETURN_IF_ERROR(CheckClosedFormOnly(flags));
  ASSIGN_OR_RETURN(auto sensor, ReadSensorFile(flags.sensor));
  ASSIGN_OR_RETURN(auto run, MakeIdentifyOptions(flags));
  static_cast<IdentifyOptions&>(options) = std::move(run);
  RETURN_IF_ERROR(ParseShared(flags, options));
  options.data = RecordingPaths(flags);
  options.data_list = flags.data_list;
  options.calibration = flags.calibration;
  options.sensor_path = std::move(sensor);
  options.rig = flags.rig;
  static_cast<FitOutputs&>(options) = static_cast<const FitOutputs&>(flags);
  RETURN_IF_ERROR(CheckJoint(flags, options));
  return options;
}

}  // namespace pendulum
