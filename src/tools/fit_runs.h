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

/// What has been read before the fits.
struct Setup {
  std::vector<std::string> paths;  ///< Paths of the recordings.
  std::vector<NamedFile> inputs;   ///< All input files, with their flags.
  std::optional<Rig> rig;
};

/// Reads the rig, the calibration (into the options) and the list of recordings. Errors as the functions that read
/// them.
Result<Setup> ReadSetup(FitPendulumOptions& options);

/// Checks the outputs of `count` runs, because several runs write numbered files instead of the named ones.
/// kInvalidArgument, kCannotWrite: as CheckOutputs; kInvalidArgument: data of several runs for standard output.
Result<void> CheckNumberedOutputs(const FitPendulumOptions& options, const Setup& setup, std::size_t count);

/// Fits all recordings and returns the runs in the order of the recordings. A recording that cannot be fitted has an
/// error at its place, and the others are fitted. A joint fit is one run; it fails if one recording cannot be fitted.
/// kInvalidArgument, kCannotWrite: as CheckNumberedOutputs, once the number of releases is known.
Result<std::vector<Result<Identification>>> FitAll(const FitPendulumOptions& options, const Setup& setup);

}  // namespace pendulum
