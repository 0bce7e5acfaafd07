// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_options.h"

#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/request/flag_values.h"
#include "pendulum/request/run_flags.h"

namespace pendulum {
namespace {

/// A plan goes to standard output and covers one recording, which is not made.
Result<void> CheckPlan(const SimulateFlags& flags) {
  const std::string contradiction = " contradicts --plan, which makes no recording; leave out one of them";
  if (!flags.out.empty()) return BadFlag("--out" + contradiction);
  if (!flags.truth.empty()) return BadFlag("--truth" + contradiction);
  if (flags.count != 1) return BadFlag("--count" + contradiction);
  if (!flags.spread.empty()) return BadFlag("--spread" + contradiction);
  if (!flags.manifest.empty()) return BadFlag("--manifest" + contradiction);
  if (flags.noise != 0 || flags.resolution != 0) return {};
  return BadFlag("--plan needs --noise or --resolution, because without them the standard errors would be 0");
}

Result<void> CheckFiles(const SimulateFlags& flags) {
  if (!flags.positional.empty()) return BadFlag("'" + flags.positional.front() + "' does not belong to a flag");
  if (flags.plan) return CheckPlan(flags);
  if (flags.details) return BadFlag("--details belongs to a plan; add --plan, or leave it out");
  if (!flags.sensor.empty()) return BadFlag("--sensor belongs to a plan; add --plan, or leave it out");
  if (flags.out.empty()) return BadFlag("--out is missing: the file for the recording, or - for standard output");
  if (flags.count < 1) return BadFlag("--count is " + std::to_string(flags.count) + "; it must be at least 1");
  if (flags.count > 1 && (IsStandardOutput(flags.out) || IsStandardOutput(flags.truth))) {
    return BadFlag("--count " + std::to_string(flags.count) + " needs files; standard output takes one recording");
  }
  if (!flags.manifest.empty() && IsStandardOutput(flags.out)) {
    return BadFlag("--manifest lists files; give --out a file instead of " + flags.out);
  }
  return {};
}

Result<void> CheckThreads(const SimulateFlags& flags) {
  constexpr int kMaxRecordingThreads = 1024;
  if (flags.threads >= 0 && flags.threads <= kMaxRecordingThreads) return {};
  return BadFlag("--threads is " + std::to_string(flags.threads) + "; it must be 0 to " +
                 std::to_string(kMaxRecordingThreads));
}

void CopyFiles(const SimulateFlags& flags, SimulateOptions& options) {
  options.plan = flags.plan;
  options.details = flags.details;
  options.count = flags.count;
  options.threads = flags.threads;
  options.rig_path = flags.rig;
  options.out = flags.out;
  options.truth_out = flags.truth;
  options.manifest_out = flags.manifest;
}

}  // namespace

Result<SimulateOptions> MakeSimulateOptions(const SimulateFlags& flags, const std::optional<Rig>& rig) {
  for (const auto check : {CheckFiles, CheckThreads}) {
    RETURN_IF_ERROR(check(flags));
  }
  ASSIGN_OR_RETURN(Simulation simulation, MakeSimulation(flags, rig));
  SimulateOptions options;
  static_cast<Simulation&>(options) = std::move(simulation);
  CopyFiles(flags, options);
  std::string sensor = flags.sensor;
  RETURN_IF_ERROR(ReadSensorFile(sensor));
  ASSIGN_OR_RETURN(options.sensor, StatedSensor(sensor));
  return options;
}

std::vector<NamedFile> SimulateOptions::Outputs(int index) const {
  std::vector<NamedFile> outputs = {{"--out", NumberedPath(out, index, count)}};
  if (!truth_out.empty()) outputs.push_back({"--truth", NumberedPath(truth_out, index, count)});
  return outputs;
}

}  // namespace pendulum
