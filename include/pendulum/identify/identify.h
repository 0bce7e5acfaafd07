// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/identify/identification.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/identify/prepared_recording.h"

namespace pendulum {

/// Identifies the pendulum from each chosen swing of one recording by itself: fits, comparison of models, constancy,
/// closed forms and checks. An element that cannot be identified holds its error: as FitModels, or kFailedPrecondition
/// if there are neither fits nor closed forms; if several swings were chosen, the message names the swing. Once
/// options.fit.stop is requested, all elements that are not finished are kTryAgain.
std::vector<Result<Identification>> IdentifyEach(const IdentifyOptions& options, PreparedRecording recording);

/// The checks of IdentifyEach before the first fit, for the first chosen swing. Cheap, so a preview can report what a
/// fit would refuse. Errors as CheckModels; kInvalidArgument: the rig has a spring, but the user chose gravity.
Result<void> CheckBeforeFit(const IdentifyOptions& options, const PreparedRecording& recording);

/// Identifies one pendulum from all chosen swings of all recordings together, with asked.shared in common. Each swing
/// is fitted alone first, on asked.fit.threads threads. Every error message names the recording. Errors: those of
/// IdentifyEach; kInvalidArgument: asked.closed_form_only, fewer than two swings, the same readings twice, or one
/// asked.read.resolution for readings of several units; kDataLoss: the recordings describe different rigs; kTryAgain:
/// asked.fit.stop was requested.
Result<Identification> IdentifyJointly(const IdentifyOptions& asked, std::vector<PreparedRecording> recordings);

/// The bytes of a file, and the name it has in messages.
struct NamedBytes {
  std::string name, bytes;
};

/// A file that all runs of a batch share; null if there is none.
using SharedFile = std::shared_ptr<const NamedBytes>;

inline SharedFile Share(NamedBytes file) { return std::make_shared<const NamedBytes>(std::move(file)); }

/// The files of one run.
struct RunFiles {
  NamedBytes data;              ///< The recording; its name becomes DataSummary::path.
  SharedFile rig, calibration;  ///< JSON.
};

/// A recording that was read from bytes, and the rig of its run.
struct ReadRun {
  Recording recording;
  std::optional<Rig> rig;  ///< std::nullopt: the run has no rig file.
};

/// Reads the files of a run. options.read receives the calibration. Errors as ParseRig, ParseCalibration and
/// ParseRecording.
Result<ReadRun> ReadBytesOfRun(IdentifyOptions& options, const RunFiles& files);

/// Reads and identifies a recording from bytes in memory. If several swings are chosen, the first is used. Errors as
/// ParseRig, ParseCalibration, ParseRecording, PrepareRecording and IdentifyEach.
Result<Identification> IdentifyBytes(IdentifyOptions options, RunFiles files);

}  // namespace pendulum
