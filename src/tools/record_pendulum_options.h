// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/acquisition/received_run.h"
#include "pendulum/base/status.h"
#include "tools/fit_pendulum_options.h"
#include "tools/output.h"

namespace pendulum {

/// The flags of record_pendulum as given.
struct RecordPendulumFlags {
  std::string port;               ///< Empty: the only one available.
  std::string out;                ///< Path, "-" for stdout; empty: none.
  std::string seconds;            ///< Empty: until it is stopped.
  std::string calibration;        ///< Path; empty: the logger's own.
  std::string store_calibration;  ///< Path; empty: none.
  std::string rig;                ///< Path; empty: none.
  std::string model;              ///< Empty: the default.
  double rate_hz = 200;
  int oversample = 1;
  int baud = 115200;
  bool until_rest = false;
  bool overwrite = false;
  bool fit = false;
  bool list = false;
  bool info = false;
  bool counts = false;
  std::vector<std::string> positional;  ///< Arguments that belong to no flag: an error.
};

enum class RecordTask { kRecord, kCounts, kStoreCalibration, kInfo, kList };

/// The task of record_pendulum.
struct RecordPendulumOptions {
  RecordTask task = RecordTask::kRecord;
  std::string port, out;
  std::string calibration;  ///< Path of the calibration to record with, or to store; empty: none.
  std::optional<double> seconds;
  bool until_rest = false, overwrite = false;
  SamplingRate rate;
  unsigned baud = 115200;
  std::optional<FitPendulumOptions> fit;  ///< Fit of the finished recording; std::nullopt: no fit.

  /// The output and input files, with their flags.
  std::vector<NamedFile> Outputs() const;
  std::vector<NamedFile> Inputs() const;
};

/// Checks the flags and converts them to options. kInvalidArgument: no output, two tasks, a flag of another task, a
/// rate that no logger has, an invalid number. The message names the flag.
Result<RecordPendulumOptions> MakeRecordPendulumOptions(const RecordPendulumFlags& flags);

/// Maximal sampling rate in Hz on a line with this baud rate, with the frames of `rate`.
double LineCapacityHz(const SamplingRate& rate, unsigned baud);

}  // namespace pendulum
