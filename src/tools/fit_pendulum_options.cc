// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_pendulum_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "pendulum/analysis/fit_models.h"
#include "pendulum/base/format.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"
#include "tools/command_line.h"

namespace pendulum {
namespace {

bool IsStandardInput(const std::string& path) { return path == "-" || path == "/dev/stdin" || path == "/dev/fd/0"; }

Result<void> CheckData(const FitPendulumFlags& flags) {
  if (!flags.positional.empty()) {
    return BadFlag("'" + flags.positional.front() + "' belongs to no flag; the recording is given with --data");
  }
  if (flags.data.empty() == flags.data_list.empty()) {
    return BadFlag(flags.data.empty() ? "no recording was given; name its CSV file with --data"
                                      : "--data and --data_list both name recordings; give one of them");
  }
  const std::vector<std::string> paths = Split(flags.data, ',');
  for (const std::string& path : paths) {
    if (path.empty()) return BadFlag("--data '" + flags.data + "' has an empty name between its commas");
  }
  if (std::ranges::count_if(paths, IsStandardInput) > 1) {
    return BadFlag("--data '" + flags.data + "' names standard input twice; it can be read once");
  }
  return {};
}

Result<int> ParseRelease(const FitPendulumFlags& flags) {
  if (flags.release.empty()) return SwingChoice::kLongest;
  if (flags.release == "all") return SwingChoice::kAll;
  const auto number = ParseNumber("--release", flags.release, "all, or the number of a release from 1 on");
  if (!number) return tl::unexpected(number.error());
  if (*number >= 1 && *number == std::floor(*number) && *number < 1e6) return static_cast<int>(*number);
  return BadFlag("--release is '" + flags.release + "'; it must be all, or the number of a release from 1 on");
}

/// One model, several between commas, or all: that of every friction law.
Result<std::vector<MotionModel>> ParseModels(const std::string& names) {
  std::vector<MotionModel> models;
  if (names == "all") {
    models = MotionModels();
    std::erase_if(models, [](const MotionModel& model) { return model.name != model.friction; });
    return models;
  }
  std::vector<std::string> parts = Split(names, ',');
  if (parts.empty() || names.ends_with(',')) parts.emplace_back();
  for (const std::string& name : parts) {
    const auto found = FindMotionModel(name);
    if (!found) return BadFlag(std::string("--model: ").append(found.error().message).append("; or all, by itself"));
    if (std::ranges::find(models, found->name, &MotionModel::name) != models.end()) {
      return BadFlag(std::string("--model '").append(names).append("' names ").append(name).append(" twice"));
    }
    models.push_back(*found);
  }
  return models;
}

Result<StartChoice> ParseStart(const std::string& start) {
  if (start == "auto") return StartChoice::kAuto;
  if (start == "release") return StartChoice::kRelease;
  if (start == "moving") return StartChoice::kMoving;
  return BadFlag("--start is '" + start + "'; it must be auto, release or moving");
}

/// A word and what it stands for.
template <typename Meaning>
struct Word {
  std::string_view word;
  Meaning meaning;
};

template <typename Meaning, std::size_t kWords>
Result<Meaning> ParseWord(std::string_view flag, const std::string& value,
                          const std::array<Word<Meaning>, kWords>& words) {
  std::vector<std::string_view> names;
  for (const auto& [word, meaning] : words) {
    if (word == value) return meaning;
    names.push_back(word);
  }
  return BadFlag(std::string(flag) + " is '" + value + "'; it must be one of " + NameList(names));
}

constexpr std::array<Word<NoiseChoice>, 3> kNoises = {
    {{"auto", NoiseChoice::kAuto}, {"gaussian", NoiseChoice::kGaussian}, {"quantized", NoiseChoice::kQuantized}}};
constexpr std::array<Word<Loss>, 3> kLosses = {
    {{"none", Loss::kNone}, {"huber", Loss::kHuber}, {"student", Loss::kStudent}}};
constexpr std::array<Word<IntervalMethod>, 4> kIntervals = {{{"auto", IntervalMethod::kAuto},
                                                             {"covariance", IntervalMethod::kCovariance},
                                                             {"profile", IntervalMethod::kProfile},
                                                             {"bootstrap", IntervalMethod::kBootstrap}}};

/// A whole number that a flag may give; `least` is what it must be at least.
Result<void> ParseWhole(std::string_view flag, const std::string& value, double least, double& number) {
  if (value.empty()) return {};
  constexpr double kLargest = 1e15;
  const std::string meaning = "a whole number, at least " + NumberText(least);
  const auto parsed = ParseNumber(flag, value, meaning);
  if (!parsed) return tl::unexpected(parsed.error());
  if (*parsed < least || *parsed != std::floor(*parsed) || *parsed > kLargest) {
    return BadFlag(std::string(flag) + " is '" + value + "'; it must be " + meaning);
  }
  number = *parsed;
  return {};
}

/// How the noise is taken, and where intervals come from.
Result<void> ParseNoise(const FitPendulumFlags& flags, FitOptions& options) {
  const auto noise = ParseWord("--noise", flags.noise, kNoises);
  if (!noise) return tl::unexpected(noise.error());
  const auto loss = ParseWord("--loss", flags.loss, kLosses);
  if (!loss) return tl::unexpected(loss.error());
  const auto interval = ParseWord("--interval", flags.interval, kIntervals);
  if (!interval) return tl::unexpected(interval.error());
  if (*loss != Loss::kNone && *noise != NoiseChoice::kAuto) {
    return BadFlag("--loss " + flags.loss + " and --noise " + flags.noise + " exclude each other; give one of them");
  }
  auto seed = static_cast<double>(options.seed);
  double threads = options.threads;
  if (auto parsed = ParseWhole("--seed", flags.seed, 0, seed); !parsed) return parsed;
  if (auto parsed = ParseWhole("--threads", flags.threads, 0, threads); !parsed) return parsed;
  constexpr double kMostThreads = 1024;
  options.noise = *noise;
  options.loss = *loss;
  options.interval = *interval;
  options.seed = static_cast<std::uint64_t>(seed);
  options.threads = static_cast<int>(std::min(threads, kMostThreads));
  return {};
}

/// Every parameter that a flag may name, whatever the start and the sensor turn out to be: that of any of the models.
std::vector<ParameterInfo> NameableParameters(const std::vector<MotionModel>& models) {
  std::vector<ParameterInfo> infos;
  for (const MotionModel& model : models) {
    for (const ParameterInfo& info : PhysicalParameters(model)) {
      if (std::ranges::find(infos, info.name, &ParameterInfo::name) == infos.end()) infos.push_back(info);
    }
  }
  infos.insert(infos.end(), {kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate, kZeroAngle, kRateBias,
                             kZeroDrift, kBiasDrift});
  return infos;
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
  if (auto parsed = ParseTime("--from", flags.from, options.swing.from); !parsed) return parsed;
  if (auto parsed = ParseTime("--to", flags.to, options.swing.to); !parsed) return parsed;
  if (options.swing.from >= options.swing.to) {
    return BadFlag("--from " + flags.from + " s does not lie before --to " + flags.to + " s");
  }
  return {};
}

/// A parameter that is held cannot be bounded or have a prior.
Result<void> CheckContradictions(const FitOptions& options) {
  for (const auto& [name, value] : options.fixed) {
    const std::string other = options.initial.contains(name)  ? "--init"
                              : options.bounds.contains(name) ? "--bounds"
                              : options.priors.contains(name) ? "--prior"
                                                              : "";
    if (other.empty()) continue;
    return BadFlag(std::string("--fix holds ")
                       .append(name)
                       .append(", and ")
                       .append(other)
                       .append(" names it too; leave one of them out"));
  }
  return {};
}

Result<void> ParseFitOptions(const FitPendulumFlags& flags, const std::vector<MotionModel>& models,
                             FitOptions& options) {
  const auto start = ParseStart(flags.start);
  if (!start) return tl::unexpected(start.error());
  const std::vector<ParameterInfo> parameters = NameableParameters(models);
  auto fixed = ParseSettings("--fix", flags.fix, flags.model, parameters);
  if (!fixed) return tl::unexpected(fixed.error());
  auto initial = ParseSettings("--init", flags.init, flags.model, parameters);
  if (!initial) return tl::unexpected(initial.error());
  auto bounds = ParseRanges("--bounds", flags.bounds, flags.model, parameters);
  if (!bounds) return tl::unexpected(bounds.error());
  auto priors = ParsePriors("--prior", flags.prior, flags.model, parameters);
  if (!priors) return tl::unexpected(priors.error());
  options.model = models.front().name;
  options.start = *start;
  options.fixed = *std::move(fixed);
  options.initial = *std::move(initial);
  options.bounds = *std::move(bounds);
  options.priors = *std::move(priors);
  if (auto parsed = ParseNoise(flags, options); !parsed) return parsed;
  return CheckContradictions(options);
}

/// Closed forms need nothing that only a fit asks for.
Result<void> CheckClosedFormOnly(const FitPendulumFlags& flags) {
  if (!flags.closed_form_only) return {};
  const FitPendulumFlags none;
  const std::array<Word<bool>, 13> of_a_fit = {{{"--shared", flags.shared != none.shared && flags.shared != "none"},
                                                {"--residuals", flags.residuals != none.residuals},
                                                {"--start", flags.start != none.start},
                                                {"--fix", flags.fix != none.fix},
                                                {"--init", flags.init != none.init},
                                                {"--bounds", flags.bounds != none.bounds},
                                                {"--prior", flags.prior != none.prior},
                                                {"--noise", flags.noise != none.noise},
                                                {"--loss", flags.loss != none.loss},
                                                {"--interval", flags.interval != none.interval},
                                                {"--seed", flags.seed != none.seed},
                                                {"--threads", flags.threads != none.threads},
                                                {"--terminal_plot", flags.terminal_plot}}};
  for (const auto& [flag, given] : of_a_fit) {
    if (!given) continue;
    return BadFlag("--closed_form_only makes no fit, which " + std::string(flag) + " is for; leave one of them out");
  }
  return {};
}

/// Contradictions that the file could not settle.
Result<void> CheckReadFlags(const FitPendulumFlags& flags) {
  const bool is_time_chosen = !flags.time_column.empty() && flags.time_column != "none";
  if (is_time_chosen && !flags.sample_rate_hz.empty()) {
    return BadFlag("--time_column and --sample_rate_hz both say what the times are; leave one of them out");
  }
  if (is_time_chosen && flags.time_column == flags.value_column) {
    return BadFlag("--time_column and --value_column are both '" + flags.time_column + "'; choose two columns");
  }
  constexpr std::array<std::string_view, 6> kUnits = {"rad", "deg", "rad_s", "deg_s", "counts", "volts"};
  if (!flags.unit.empty() && std::ranges::find(kUnits, flags.unit) == kUnits.end()) {
    return BadFlag("--unit is '" + flags.unit + "'; it must be one of " + NameList(kUnits));
  }
  if (!flags.calibration.empty() && !flags.unit.empty() && flags.unit != "counts" && flags.unit != "volts") {
    return BadFlag("--calibration turns counts or volts into an angle, and --unit says that the values are in " +
                   flags.unit + "; leave one of them out");
  }
  return {};
}

/// What the sensor can show, in the unit of the file.
Result<void> ParseSensor(const FitPendulumFlags& flags, ReadOptions& options) {
  if (!flags.resolution.empty()) {
    const auto resolution = ParseNumber("--resolution", flags.resolution, "a number, 0 or more, in the file's unit");
    if (!resolution) return tl::unexpected(resolution.error());
    if (*resolution < 0) return BadFlag("--resolution is '" + flags.resolution + "'; it must be 0 or more");
    options.resolution = *resolution;
  }
  if (flags.range.empty()) return {};
  const std::string meaning = "two increasing numbers, low,high, in the file's unit";
  const std::vector<std::string> ends = Split(flags.range, ',');
  if (ends.size() != 2) return BadFlag("--range is '" + flags.range + "'; it must be " + meaning);
  const auto low = ParseNumber("--range", ends[0], meaning);
  if (!low) return tl::unexpected(low.error());
  const auto high = ParseNumber("--range", ends[1], meaning);
  if (!high) return tl::unexpected(high.error());
  if (*low >= *high) return BadFlag("--range is '" + flags.range + "'; it must be " + meaning);
  options.range = SensorRange{*low, *high};
  return {};
}

Result<void> ParseReadOptions(const FitPendulumFlags& flags, ReadOptions& options) {
  if (auto checked = CheckReadFlags(flags); !checked) return checked;
  if (auto parsed = ParseSensor(flags, options); !parsed) return parsed;
  options.time_column = flags.time_column;
  options.value_column = flags.value_column;
  options.unit = flags.unit;
  if (flags.sample_rate_hz.empty()) return {};
  const auto rate = ParseNumber("--sample_rate_hz", flags.sample_rate_hz, "a positive number of samples per second");
  if (!rate) return tl::unexpected(rate.error());
  if (*rate <= 0) return BadFlag("--sample_rate_hz is '" + flags.sample_rate_hz + "'; it must be positive");
  options.sample_rate_hz = *rate;
  return {};
}

/// What recordings share: all of inertia and friction unless it is said.
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

/// A joint fit has the intervals of its covariance, or profiles.
Result<void> CheckJoint(const FitPendulumFlags& flags, const FitPendulumOptions& options) {
  const bool joint = options.IsJoint(options.data.size()) || (!flags.data_list.empty() && options.IsJoint(2));
  if (!joint || options.fit.interval != IntervalMethod::kBootstrap) return {};
  return BadFlag(
      "--interval bootstrap is for recordings one by one (--shared none); several together have covariance "
      "and profile");
}

}  // namespace

std::vector<NamedFile> FitPendulumOptions::Outputs(int index, int count) const {
  std::vector<NamedFile> outputs;
  if (!json.empty()) outputs.push_back({"--json", NumberedPath(json, index, count)});
  if (!residuals.empty()) outputs.push_back({"--residuals", NumberedPath(residuals, index, count)});
  if (!series.empty()) outputs.push_back({"--series", NumberedPath(series, index, count)});
  if (!report.empty()) outputs.push_back({"--report", NumberedPath(report, index, count)});
  if (!markdown.empty()) outputs.push_back({"--markdown", NumberedPath(markdown, index, count)});
  return outputs;
}

std::vector<NamedFile> FitPendulumOptions::JointOutputs(int recordings) const {
  std::vector<NamedFile> outputs = Outputs();
  std::erase_if(outputs, [](const NamedFile& output) { return output.flag == "--residuals"; });
  for (int k = 0; k < recordings && !residuals.empty(); ++k) {
    outputs.push_back({"--residuals", NumberedPath(residuals, k, recordings)});
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
  if (!rig.empty()) inputs.push_back({"--rig", rig});
  return inputs;
}

Result<FitPendulumOptions> MakeFitPendulumOptions(const FitPendulumFlags& flags) {
  FitPendulumOptions options;
  if (const auto checked = CheckData(flags); !checked) return tl::unexpected(checked.error());
  if (const auto checked = CheckClosedFormOnly(flags); !checked) return tl::unexpected(checked.error());
  const auto models = ParseModels(flags.model);
  if (!models) return tl::unexpected(models.error());
  for (const MotionModel& model : *models) options.models.emplace_back(model.name);
  if (const auto parsed = ParseFitOptions(flags, *models, options.fit); !parsed) return tl::unexpected(parsed.error());
  if (const auto parsed = ParseWindow(flags, options); !parsed) return tl::unexpected(parsed.error());
  const auto release = ParseRelease(flags);
  if (!release) return tl::unexpected(release.error());
  options.swing.release = *release;
  if (const auto parsed = ParseShared(flags, options); !parsed) return tl::unexpected(parsed.error());
  options.data = Split(flags.data, ',');
  options.data_list = flags.data_list;
  if (const auto parsed = ParseReadOptions(flags, options.read); !parsed) return tl::unexpected(parsed.error());
  options.calibration = flags.calibration;
  options.rig = flags.rig;
  options.json = flags.json;
  options.residuals = flags.residuals;
  options.series = flags.series;
  options.report = flags.report;
  options.markdown = flags.markdown;
  options.terminal_plot = flags.terminal_plot;
  options.closed_form_only = flags.closed_form_only;
  if (const auto checked = CheckJoint(flags, options); !checked) return tl::unexpected(checked.error());
  return options;
}

}  // namespace pendulum
