// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/simulate_pendulum_options.h"

namespace pendulum {

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
