// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit.h"
#include "pendulum/recording/read_recording.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of fit_pendulum as they were given; empty, or the default, where they were not.
struct FitPendulumFlags {
  std::string data;
  std::string rig;
  std::string model = "coulomb";
  std::string start = "auto";
  std::string from;
  std::string to;
  std::string fix;
  std::string json;
  std::string residuals;
  std::string calibration;
  std::string time_column;
  std::string value_column;
  std::string unit;
  std::string sample_rate_hz;
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

/// What fit_pendulum is asked to do.
struct FitPendulumOptions {
  std::string data;  ///< Path of the recording; "-" is standard input.
  std::string
      calibration;  ///< Path of the calibration; empty for none. ReadOptions::calibration is to be read from it.
  ReadOptions read;
  std::string rig;  ///< Path of the rig file; empty for none. FitOptions::rig is for the caller to read from it.
  double from = std::numeric_limits<double>::quiet_NaN();  ///< s on the file's clock; NaN leaves that end open.
  double to = std::numeric_limits<double>::quiet_NaN();    ///< s on the file's clock; NaN leaves that end open.
  std::string json;       ///< Path of the result; "-" is standard output; empty for none.
  std::string residuals;  ///< Path of the samples beside the fit; "-" is standard output; empty for none.
  FitOptions fit;

  /// The files to be written and read, with their flags.
  std::vector<NamedFile> Outputs() const;
  std::vector<NamedFile> Inputs() const;
};

/// Turns flags into options. kInvalidArgument: a flag is missing, wrong or contradicts another; the message names it.
Result<FitPendulumOptions> MakeFitPendulumOptions(const FitPendulumFlags& flags);

}  // namespace pendulum
