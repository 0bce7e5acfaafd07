// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/analysis/coverage.h"
#include "pendulum/base/status.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of coverage_study as given.
struct CoverageFlags {
  std::string scenario;  ///< name,... or all
  int count = 1000;
  int runs = 1;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string markdown;                 ///< Path, "-" for stdout; empty: none.
  bool list = false;                    ///< Lists the scenarios' names.
  std::vector<std::string> positional;  ///< Arguments that belong to no flag: an error.
};

/// The task of coverage_study.
struct CoverageStudyOptions {
  std::vector<CoverageScenario> scenarios;  ///< To be studied, or listed.
  CoverageOptions study;
  bool list = false;
  std::string markdown;  ///< As in the flags.
  std::string command;   ///< The command that makes the same tables.

  /// The output files, with their flags.
  std::vector<NamedFile> Outputs() const;
};

/// Checks the flags and converts them to options.
///
/// kInvalidArgument: no scenario or an unknown one (the message lists the known ones), a number outside its domain, an
/// argument without a flag. The message names the flag.
Result<CoverageStudyOptions> MakeCoverageStudyOptions(const CoverageFlags& flags);

}  // namespace pendulum
