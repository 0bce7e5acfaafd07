// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/request/run_flags.h"
#include "tools/output.h"

namespace pendulum {

/// Where fit_pendulum writes what; "-" is standard output, empty: nowhere.
struct FitOutputs {
  std::string json;            ///< Path of the result.
  std::string residuals;       ///< Path of samples and fit.
  std::string series;          ///< Path of samples, fit, turning points and models.
  std::string report;          ///< Path of the HTML page with all results.
  std::string plot;            ///< Path of the picture.
  std::string markdown;        ///< Path of the result as Markdown.
  bool terminal_plot = false;  ///< Plots the recording on standard output.
  bool details = false;        ///< Prints all of the result, not only its summary.
  bool quiet = false;          ///< Prints the parameters alone.
};

/// The flags of fit_pendulum as given; empty or the default if not given.
struct FitPendulumFlags : RunFlags, FitOutputs {
  std::string data;
  std::string data_list;
  std::string shared;
  std::vector<std::string> positional;  ///< Arguments that belong to no flag: recordings, instead of `data`.
};

/// Whether recordings are fitted together. By default several recordings are fitted together, and several releases of
/// one recording are fitted separately.
enum class Sharing { kByDefault, kNothing, kAsked };

/// The task of fit_pendulum.
struct FitPendulumOptions : IdentifyOptions, FitOutputs {
  std::vector<std::string> data;  ///< Paths of the recordings; "-" is standard input.
  std::string data_list;          ///< Path of a file that lists the recordings instead; empty: none.
  std::string sensor_path;        ///< Of the file that --sensor named; empty: none.
  std::string calibration;        ///< Path; empty: none. The caller reads ReadOptions::calibration from it.
  std::string rig;                ///< Path of the rig file; empty: none. The caller reads FitOptions::rig from it.
  Sharing sharing = Sharing::kByDefault;

  /// The output files of fit `index` (0-based) of `count`, with their flags; numbered if there are several fits.
  std::vector<NamedFile> Outputs(int index = 0, int count = 1) const;

  /// The output files of one joint fit of `recordings`; residuals and picture of each recording are numbered.
  std::vector<NamedFile> JointOutputs(int recordings) const;

  /// Whether this many recordings are fitted together.
  bool IsJoint(std::size_t recordings) const;

  /// The input files, with their flags.
  std::vector<NamedFile> Inputs() const;
};

/// Converts flags to options. kInvalidArgument: a flag is missing, wrong or contradicts another; the message names it.
Result<FitPendulumOptions> MakeFitPendulumOptions(const FitPendulumFlags& given);

}  // namespace pendulum
