// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/identify/identify.h"
#include "pendulum/model/rig.h"
#include "tools/fit_pendulum_options.h"
#include "tools/output.h"

namespace pendulum {

/// What the runs need beside their flags.
struct Setup {
  std::vector<std::string> paths;  ///< Of the recordings.
  std::vector<NamedFile> inputs;   ///< All that is read.
  std::optional<Rig> rig;
};

/// Reads rig, calibration (into the options) and list of recordings. Errors as their readers.
Result<Setup> ReadSetup(FitPendulumOptions& options);

/// Numbered outputs are other files than those that were named; data of several fits have no place on one stream.
/// kInvalidArgument, kCannotWrite: as CheckOutputs, or standard output for more than one.
Result<void> CheckNumberedOutputs(const FitPendulumOptions& options, const Setup& setup, std::size_t count);

/// The runs of all recordings, in their order: one that cannot be fitted keeps its place, and the others go on. A joint
/// fit is one run, and none where one of its recordings cannot be fitted.
/// kInvalidArgument, kCannotWrite: outputs that are one too many once the releases are counted.
Result<std::vector<Result<Identification>>> FitAll(const FitPendulumOptions& options, const Setup& setup);

}  // namespace pendulum
