// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/identify/identify_options.h"

namespace pendulum {

/// Everything that determines the rows of a run. While the provenance is unchanged, the run need not be fitted again.
/// `cpu` is reported but not compared: another type of CPU changes only the last bits.
struct Provenance {
  std::string data_sha256, rig_sha256, calibration_sha256;  ///< Of the bytes; empty: no file; or "unreadable: why".
  std::string options_sha256;                               ///< Hash of OptionsJson of the run's options.
  std::string version;                                      ///< Version of the program.
  std::string cpu;                                          ///< CpuType.

  /// Whether everything except `cpu` is equal.
  bool Agrees(const Provenance& other) const;
};

/// All options that the result depends on, as a JSON object; equal options give equal text. Calibration and rig are not
/// included, because their bytes are hashed.
std::string OptionsJson(const IdentifyOptions& options);

/// "Intel(R) Xeon(R) Processor (avx512)": the processor, and the variant of the arithmetic chosen for it.
const std::string& CpuType();

}  // namespace pendulum
