// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pendulum/analysis/coverage.h"
#include "pendulum/base/status.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of coverage_study as they were given.
struct CoverageFlags {
  std::string scenario;  ///< name,... or all
  int count = 1000;
  int runs = 1;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string markdown;                 ///< Path, "-" for stdout, or empty for none.
  bool list = false;                    ///< Asks for the scenarios' names.
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// What coverage_study is to do.
struct CoverageStudyOptions {
  std::vector<CoverageScenario> scenarios;  ///< To be studied, or listed.
  CoverageOptions study;
  bool list = false;
  std::string markdown;  ///< As in the flags.
  std::string command;   ///< That makes the same tables again.

  /// The files to be written, with their flags.
  std::vector<NamedFile> Outputs() const;
};

/// Checks the flags and turns them into what is to be done.
///
/// kInvalidArgument: no scenario or an unknown one (the message lists those there are), a number outside its domain,
/// something that belongs to no flag; the message names the flag.
Result<CoverageStudyOptions> MakeCoverageStudyOptions(const CoverageFlags& flags);

}  // namespace pendulum
