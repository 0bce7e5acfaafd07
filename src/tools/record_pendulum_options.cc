// SPDX-License-Identifier: Apache-2.0
#include "tools/record_pendulum_options.h"

#include <algorithm>
#include <array>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/request/flag_values.h"

namespace pendulum {
namespace {

namespace wire = pendulum_logger;

constexpr double kLongestRun = 1e6;   // s, eleven days
constexpr double kCountsSeconds = 1;  // averaged by --counts

Result<RecordTask> ChooseTask(const RecordPendulumFlags& flags) {
  using RequestedTask = std::pair<bool, RecordTask>;
  const std::array<RequestedTask, 5> asked = {{{!flags.out.empty(), RecordTask::kRecord},
                                               {flags.counts, RecordTask::kCounts},
                                               {!flags.store_calibration.empty(), RecordTask::kStoreCalibration},
                                               {flags.info, RecordTask::kInfo},
                                               {flags.list, RecordTask::kList}}};
  const auto count = std::ranges::count(asked, true, &RequestedTask::first);
  if (count == 0) {
    return BadFlag(
        "--out is missing; name the file for the recording, or give --counts, --store_calibration, --info or --list");
  }
  if (count > 1) {
    return BadFlag("give only one of --out, --counts, --store_calibration, --info and --list");
  }
  return std::ranges::find(asked, true, &RequestedTask::first)->second;
}

/// Refuses flags of a recording for other tasks.
Result<void> CheckBelongs(const RecordPendulumFlags& flags) {
  const RecordPendulumFlags unset;
  const std::array<std::pair<bool, const char*>, 9> of_a_recording = {{{!flags.seconds.empty(), "--seconds"},
                                                                       {flags.until_rest, "--until_rest"},
                                                                       {flags.overwrite, "--overwrite"},
                                                                       {flags.fit, "--fit"},
                                                                       {!flags.calibration.empty(), "--calibration"},
                                                                       {!flags.rig.empty(), "--rig"},
                                                                       {!flags.model.empty(), "--model"},
                                                                       {flags.rate_hz != unset.rate_hz, "--rate_hz"},
                                                                       {flags.oversample != 1, "--oversample"}}};
  for (const auto& [is_given, flag] : of_a_recording) {
    if (is_given) return BadFlag(std::string(flag) + " belongs to a recording; add --out, or leave it out");
  }
  return {};
}

Result<SamplingRate> ChooseRate(const RecordPendulumFlags& flags) {
  if (flags.oversample < 1 || flags.oversample > wire::kMaxOversample) {
    return BadFlag("--oversample is " + std::to_string(flags.oversample) + "; it must be 1 to " +
                   std::to_string(wire::kMaxOversample));
  }
  if (const auto rate = NearestRate(flags.rate_hz, flags.oversample)) return *rate;
  const auto ends = [&](std::uint16_t period) {
    return NumberText(static_cast<double>(wire::kTickHz) / period / flags.oversample, 4);
  };
  return BadFlag("--rate_hz is " + NumberText(flags.rate_hz) + "; with --oversample " +
                 std::to_string(flags.oversample) + " it must be " + ends(wire::kMaxPeriod) + " to " +
                 ends(wire::kMinPeriod));
}

Result<void> ChooseEnd(const RecordPendulumFlags& flags, RecordPendulumOptions& options) {
  options.until_rest = flags.until_rest;
  if (flags.seconds.empty()) return {};
  const auto seconds = ParseNumber("--seconds", flags.seconds, "a number of seconds");
  if (!seconds) return tl::unexpected(seconds.error());
  if (!(*seconds > 0 && *seconds <= kLongestRun)) {
    return BadFlag("--seconds is " + flags.seconds + "; it must be positive, at most " + NumberText(kLongestRun));
  }
  if (*seconds * options.rate.Hz() < 1) return BadFlag("--seconds is " + flags.seconds + ", less than a sample takes");
  options.seconds = *seconds;
  return {};
}

Result<void> ChooseFit(const RecordPendulumFlags& flags, RecordPendulumOptions& options) {
  if (!flags.fit) {
    if (!flags.rig.empty()) return BadFlag("--rig belongs to a fit; add --fit, or leave it out");
    if (!flags.model.empty()) return BadFlag("--model belongs to a fit; add --fit, or leave it out");
    return {};
  }
  if (IsStandardOutput(flags.out)) return BadFlag("--fit needs a recording in a file; give --out one");
  FitPendulumFlags fit;
  fit.data = "-";
  fit.rig = flags.rig;
  if (!flags.model.empty()) fit.model = flags.model;
  ASSIGN_OR_RETURN(auto made, MakeFitPendulumOptions(fit));
  made.data = {flags.out};  // one path, even if it contains commas
  options.fit = std::move(made);
  return {};
}

}  // namespace

std::vector<NamedFile> RecordPendulumOptions::Outputs() const {
  if (task != RecordTask::kRecord) return {};
  return {{"--out", out}};
}

std::vector<NamedFile> RecordPendulumOptions::Inputs() const {
  std::vector<NamedFile> inputs;
  const std::string flag = task == RecordTask::kStoreCalibration ? "--store_calibration" : "--calibration";
  if (!calibration.empty()) inputs.push_back({flag, calibration});
  if (fit && !fit->rig.empty()) inputs.push_back({"--rig", fit->rig});
  return inputs;
}

Result<RecordPendulumOptions> MakeRecordPendulumOptions(const RecordPendulumFlags& flags) {
  if (!flags.positional.empty()) return BadFlag("'" + flags.positional.front() + "' does not belong to a flag");
  ASSIGN_OR_RETURN(const auto task, ChooseTask(flags));
  RecordPendulumOptions options;
  options.task = task;
  options.port = flags.port;
  if (flags.baud < 1200 || flags.baud > 2000000) {
    return BadFlag("--baud is " + std::to_string(flags.baud) + "; it must be what the sketch has, 1200 to 2000000");
  }
  options.baud = static_cast<unsigned>(flags.baud);
  if (task != RecordTask::kRecord) {
    options.calibration = flags.store_calibration;
    options.seconds = kCountsSeconds;
    RETURN_IF_ERROR(CheckBelongs(flags));
    return options;
  }
  options.out = flags.out;
  options.calibration = flags.calibration;
  options.overwrite = flags.overwrite;
  ASSIGN_OR_RETURN(const auto rate, ChooseRate(flags));
  options.rate = rate;
  RETURN_IF_ERROR(ChooseEnd(flags, options));
  RETURN_IF_ERROR(ChooseFit(flags, options));
  return options;
}

double LineCapacityHz(const SamplingRate& rate, unsigned baud) {
  constexpr double kBitsPerByte = 10;  // including start and stop bit
  const int block = wire::BlockSize(static_cast<std::uint32_t>(rate.Ticks()));
  return baud / kBitsPerByte * block / wire::DataFrameSize(block);
}

}  // namespace pendulum
