// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/simulate_pendulum_options.h"

namespace pendulum {

/// The list of the recordings that were made: path, id, rig (with --rig), seed and the truth's parameters. A header,
/// then a row for each, in lines that end with \n; paths are seen from the manifest's folder, or from the current one
/// where it goes to standard output.
class Manifest {
 public:
  /// Of options whose outputs have been checked, so that their folders are there; they must outlive it.
  explicit Manifest(const SimulateOptions& options);

  /// "path,id,rig,seed,true_inertia,...".
  std::string Header() const;

  /// The row of recording `index` (0-based). kInvalidArgument: as SimulationOfRecording.
  Result<std::string> Row(int index) const;

 private:
  const SimulateOptions& options_;
  std::string folder_;  ///< Where the recordings are, "" or with a slash at its end.
  std::string rig_;     ///< As a field; empty for none.
};

}  // namespace pendulum
