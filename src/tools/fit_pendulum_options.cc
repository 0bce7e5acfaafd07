// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_pendulum_options.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"
#include "tools/command_line.h"

namespace pendulum {
namespace {

tl::unexpected<Status> Wrong(const std::string& message) { return Error(StatusCode::kInvalidArgument, message); }

Result<void> CheckData(const FitPendulumFlags& flags) {
  if (!flags.positional.empty()) {
    return Wrong("'" + flags.positional.front() + "' belongs to no flag; the recording is given with --data");
  }
  if (flags.data.empty()) return Wrong("no recording was given; name its CSV file with --data");
  if (flags.data == "-") return Wrong("--data - (standard input) is not supported; name a file");
  if (flags.data.find(',') != std::string::npos) {
    return Wrong("--data '" + flags.data + "' has a comma; it takes one file, whose name has none");
  }
  return {};
}

Result<std::string> ParseModel(const std::string& model) {
  if (model.find(',') != std::string::npos || model == "all") {
    return Wrong("--model '" + model + "' asks for several models; it takes one of " + MotionModelNames());
  }
  if (const auto found = FindMotionModel(model); !found) return Wrong("--model: " + found.error().message);
  return model;
}

Result<StartChoice> ParseStart(const std::string& start) {
  if (start == "auto") return StartChoice::kAuto;
  if (start == "release") return StartChoice::kRelease;
  if (start == "moving") return StartChoice::kMoving;
  return Wrong("--start is '" + start + "'; it must be auto, release or moving");
}

/// Every name that --fix may give for a model, whatever the start and the sensor turn out to be.
std::vector<std::string_view> FixableNames(const MotionModel& model) {
  std::vector<std::string_view> names;
  for (const ParameterInfo& parameter : PhysicalParameters(model)) names.push_back(parameter.name);
  for (const ParameterInfo& parameter :
       {kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate, kZeroAngle, kRateBias}) {
    names.push_back(parameter.name);
  }
  return names;
}

Result<void> CheckFixable(const std::string& name, const std::string& model) {
  const std::vector<std::string_view> names = FixableNames(*FindMotionModel(model));
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  std::string list;
  for (const std::string_view valid : names) list.append(list.empty() ? "" : ", ").append(valid);
  return Wrong("--fix: the model '" + model + "' has no parameter '" + name + "'; its parameters are " + list);
}

Result<std::map<std::string, double>> ParseFix(const std::string& fix, const std::string& model) {
  std::map<std::string, double> fixed;
  for (std::size_t begin = 0; begin < fix.size();) {
    const std::size_t end = std::min(fix.find(',', begin), fix.size());
    const std::string entry = fix.substr(begin, end - begin);
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) return Wrong("--fix: '" + entry + "' must be name=value");
    const std::string name = entry.substr(0, equals);
    if (const auto fixable = CheckFixable(name, model); !fixable) return tl::unexpected(fixable.error());
    const auto value = ParseNumber("--fix " + name, entry.substr(equals + 1), "a number in SI units");
    if (!value) return tl::unexpected(value.error());
    if (!fixed.emplace(name, *value).second) return Wrong("--fix: '" + name + "' stands there twice");
    begin = end + 1;
    if (begin == fix.size()) return Wrong("--fix: '" + fix + "' ends with a comma");
  }
  return fixed;
}

/// Reads a time unless the flag was left out.
Result<void> ParseTime(std::string_view flag, const std::string& value, double& time) {
  if (value.empty()) return {};
  const auto number = ParseNumber(flag, value, "a time in seconds on the file's clock");
  if (!number) return tl::unexpected(number.error());
  time = *number;
  return {};
}

Result<void> ParseWindow(const FitPendulumFlags& flags, FitPendulumOptions& options) {
  if (auto parsed = ParseTime("--from", flags.from, options.from); !parsed) return parsed;
  if (auto parsed = ParseTime("--to", flags.to, options.to); !parsed) return parsed;
  if (options.from >= options.to) {
    return Wrong("--from " + flags.from + " s does not lie before --to " + flags.to + " s");
  }
  return {};
}

Result<void> ParseFitOptions(const FitPendulumFlags& flags, FitOptions& options) {
  const auto model = ParseModel(flags.model);
  if (!model) return tl::unexpected(model.error());
  const auto start = ParseStart(flags.start);
  if (!start) return tl::unexpected(start.error());
  auto fixed = ParseFix(flags.fix, *model);
  if (!fixed) return tl::unexpected(fixed.error());
  options.model = *model;
  options.start = *start;
  options.fixed = *std::move(fixed);
  return {};
}

}  // namespace

std::vector<NamedFile> FitPendulumOptions::Outputs() const {
  std::vector<NamedFile> outputs;
  if (!json.empty()) outputs.push_back({"--json", json});
  if (!residuals.empty()) outputs.push_back({"--residuals", residuals});
  return outputs;
}

std::vector<NamedFile> FitPendulumOptions::Inputs() const {
  std::vector<NamedFile> inputs = {{"--data", data}};
  if (!rig.empty()) inputs.push_back({"--rig", rig});
  return inputs;
}

Result<FitPendulumOptions> MakeFitPendulumOptions(const FitPendulumFlags& flags) {
  FitPendulumOptions options;
  if (const auto checked = CheckData(flags); !checked) return tl::unexpected(checked.error());
  if (const auto parsed = ParseFitOptions(flags, options.fit); !parsed) return tl::unexpected(parsed.error());
  if (const auto parsed = ParseWindow(flags, options); !parsed) return tl::unexpected(parsed.error());
  options.data = flags.data;
  options.rig = flags.rig;
  options.json = flags.json;
  options.residuals = flags.residuals;
  return options;
}

}  // namespace pendulum
