// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/base/status.h"
#include "tools/simulate_pendulum_options.h"

namespace pendulum {

/// Checks with CheckOutputs that all files can be written. Then it makes the recordings on options.threads threads, and
/// finally the manifest. Memory does not grow with the number of recordings.
///
/// The files of a single recording are synchronised as in WriteOutputs. For several recordings the file system is
/// synchronised once after all files, before the manifest. If several recordings fail, the error of the first of them
/// is returned; files of other recordings may exist then. Codes of CheckOutputs, WriteOutputs, SimulateRecording,
/// SimulationOfRecording.
Result<void> WriteRecordings(const SimulateOptions& options);

/// The list of the simulated recordings: path, id, rig (with --rig), seed and the true parameters. A header, then one
/// row per recording, in lines that end with \n. Paths are relative to the manifest's folder, or to the current folder
/// if it goes to standard output.
class Manifest {
 public:
  /// The options must have passed CheckOutputs, so that their folders exist, and must outlive the manifest.
  explicit Manifest(const SimulateOptions& options);

  /// "path,id,rig,seed,true_inertia,...".
  std::string Header() const;

  /// The row of recording `index` (0-based). kInvalidArgument: as SimulationOfRecording.
  Result<std::string> Row(int index) const;

 private:
  const SimulateOptions& options_;
  std::string folder_;  ///< Folder of the recordings: "" or with a slash at its end.
  std::string rig_;     ///< As a CSV field; empty: none.
};

}  // namespace pendulum
