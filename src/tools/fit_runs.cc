// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_runs.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "pendulum/base/file.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"
#include "pendulum/identify/prepared_recording.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/recording/calibration/calibration_source.h"
#include "pendulum/recording/readers/data_list.h"

namespace pendulum {

Result<Setup> ReadSetup(FitPendulumOptions& options) {
  Setup setup{options.data, options.Inputs(), std::nullopt};
  if (!options.rig.empty()) {
    ASSIGN_OR_RETURN(const auto text, ReadFile(options.rig, "rig", kMaxJsonBytes));
    ASSIGN_OR_RETURN(auto rig, ParseRigWith(options.rig_values, text, options.rig, options.notes));
    setup.rig = std::move(rig);
  }
  if (!options.calibration.empty()) {
    ASSIGN_OR_RETURN(auto calibration, CalibrationFromFile(options.calibration));
    options.read.calibration = std::move(calibration);
  }
  if (options.data_list.empty()) return setup;
  ASSIGN_OR_RETURN(const auto listed, ReadDataList(options.data_list));
  for (const ListedFile& file : listed) {
    setup.paths.push_back(file.path.string());
    setup.inputs.push_back({"--data_list", file.path.string()});
  }
  return setup;
}

Result<void> CheckNumberedOutputs(const FitPendulumOptions& options, const Setup& setup, std::size_t count) {
  if (options.IsJoint(setup.paths.size())) {
    if (count > 1 && IsStandardOutput(options.residuals)) {
      return Error(StatusCode::kInvalidArgument, "--residuals " + options.residuals +
                                                     " takes one recording, but there are " + std::to_string(count) +
                                                     "; give a file name, to which the number is added");
    }
    return CheckOutputs(options.JointOutputs(static_cast<int>(count)), setup.inputs);
  }
  if (count == 1) return {};
  for (const NamedFile& output : options.Outputs()) {
    if (!IsStandardOutput(output.path)) continue;
    return Error(StatusCode::kInvalidArgument, output.flag + " " + output.path + " takes one fit, but there are " +
                                                   std::to_string(count) +
                                                   "; give a file name, to which the number is added");
  }
  std::vector<NamedFile> outputs;
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::move(options.Outputs(static_cast<int>(i), static_cast<int>(count)), std::back_inserter(outputs));
  }
  return CheckOutputs(outputs, setup.inputs);
}

namespace {

/// Prepares all recordings of a joint fit, and checks the outputs, whose number is that of the chosen swings.
Result<std::vector<PreparedRecording>> PrepareAll(const FitPendulumOptions& options, const Setup& setup) {
  std::vector<PreparedRecording> recordings;
  std::size_t count = 0;
  for (const std::string& path : setup.paths) {
    auto one = PrepareFile(path, options, setup.rig);
    if (!one) return ErrorOfRun(one.error(), path, 0);
    count += one->swings.chosen.size();
    recordings.push_back(*std::move(one));
  }
  RETURN_IF_ERROR(CheckNumberedOutputs(options, setup, count));
  return recordings;
}

/// Whether an error is about the readings, not about a flag.
bool IsOfData(const Status& error) {
  return error.code == StatusCode::kDataLoss || error.code == StatusCode::kFailedPrecondition;
}

}  // namespace

Result<std::vector<Result<Identification>>> FitAll(const FitPendulumOptions& options, const Setup& setup) {
  std::vector<Result<Identification>> runs;
  if (options.IsJoint(setup.paths.size())) {
    ASSIGN_OR_RETURN(auto recordings, PrepareAll(options, setup));
    ASSIGN_OR_RETURN(auto joint, IdentifyJointly(options, std::move(recordings)));
    runs.emplace_back(std::move(joint));
    return runs;
  }
  const std::size_t files = setup.paths.size();
  std::size_t count = files;  // number of runs; a recording that cannot be read counts as one
  for (const std::string& path : setup.paths) {
    auto one = PrepareFile(path, options, setup.rig);
    if (!one) {
      runs.emplace_back(files > 1 ? ErrorOfRun(one.error(), path, 0) : tl::unexpected(one.error()));
      continue;
    }
    if (const std::size_t more = one->swings.chosen.size() - 1; more > 0) {
      count += more;
      RETURN_IF_ERROR(CheckNumberedOutputs(options, setup, count));
    }
    for (Result<Identification>& run : IdentifyEach(options, *std::move(one))) {
      if (!run && (files > 1 || IsOfData(run.error()))) run = ErrorOfRun(run.error(), path, 0);
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

}  // namespace pendulum
