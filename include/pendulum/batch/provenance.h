// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/identify/identify_options.h"

namespace pendulum {

/// All that the rows of a run follow from: while none of it changes, the run need not be fitted again. `cpu` is told,
/// but does not count: another type of CPU changes the last bits only.
struct Provenance {
  std::string data_sha256, rig_sha256, calibration_sha256;  ///< Of files' bytes; empty: none; "unreadable: why".
  std::string options_sha256;                               ///< Of OptionsJson of its own options.
  std::string version;                                      ///< Of the program.
  std::string cpu;                                          ///< CpuType.

  /// Whether all that counts is the same.
  bool Agrees(const Provenance& other) const;
};

/// The options as a JSON object, every one that the result depends on: the same options give the same text. Calibration
/// and rig are not in it, for their bytes are hashed.
std::string OptionsJson(const IdentifyOptions& options);

/// "Intel(R) Xeon(R) Processor (avx512)": the processor, and which form of the arithmetic is chosen for it.
const std::string& CpuType();

}  // namespace pendulum
