// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/request/run_flags.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of fit_pendulum as they were given; empty, or the default, where they were not.
struct FitPendulumFlags : RunFlags {
  std::string data;
  std::string data_list;
  std::string json;
  std::string residuals;
  std::string series;
  std::string report;
  std::string markdown;
  std::string shared;
  bool terminal_plot = false;
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// Whether recordings are fitted together: unless it is said, several recordings are, and the releases of one are not.
enum class Sharing { kByDefault, kNothing, kAsked };

/// What fit_pendulum is asked to do.
struct FitPendulumOptions : IdentifyOptions {
  std::vector<std::string> data;  ///< Paths of the recordings; "-" is standard input.
  std::string data_list;          ///< Path of a file that lists them instead; empty for none.
  std::string calibration;        ///< Path; empty for none. ReadOptions::calibration is for the caller to read from it.
  std::string rig;        ///< Path of the rig file; empty for none. FitOptions::rig is for the caller to read from it.
  std::string json;       ///< Path of the result; "-" is standard output; empty for none.
  std::string residuals;  ///< Path of the samples beside the fit; "-" is standard output; empty for none.
  std::string series;     ///< Path of the same with turning points and models; "-" is standard output; empty for none.
  std::string report;     ///< Path of the page that shows all of it; "-" is standard output; empty for none.
  std::string markdown;   ///< Path of the result for a notebook; "-" is standard output; empty for none.
  bool terminal_plot = false;  ///< Draws the recording on standard output.
  Sharing sharing = Sharing::kByDefault;

  /// The files that fit `index` (0-based) of `count` writes, with their flags: numbered where there are several.
  std::vector<NamedFile> Outputs(int index = 0, int count = 1) const;

  /// Those of one joint fit of `recordings`: numbered are the residuals of each.
  std::vector<NamedFile> JointOutputs(int recordings) const;

  /// Whether that many recordings are fitted together.
  bool IsJoint(std::size_t recordings) const;

  /// The files to be read, with their flags.
  std::vector<NamedFile> Inputs() const;
};

/// Turns flags into options. kInvalidArgument: a flag is missing, wrong or contradicts another; the message names it.
Result<FitPendulumOptions> MakeFitPendulumOptions(const FitPendulumFlags& flags);

}  // namespace pendulum
