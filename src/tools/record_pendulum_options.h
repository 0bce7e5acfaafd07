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

/// The flags of record_pendulum as they were given.
struct RecordPendulumFlags {
  std::string port;               ///< Empty for the only one there is.
  std::string out;                ///< Path, "-" for stdout, or empty.
  std::string seconds;            ///< Empty for until it is stopped.
  std::string calibration;        ///< Path, or empty for the logger's own.
  std::string store_calibration;  ///< Path, or empty.
  std::string rig;                ///< Path, or empty for none.
  std::string model;              ///< Empty for the default.
  double rate_hz = 200;
  int oversample = 1;
  int baud = 115200;
  bool until_rest = false;
  bool overwrite = false;
  bool fit = false;
  bool list = false;
  bool info = false;
  bool counts = false;
  std::vector<std::string> positional;  ///< What belongs to no flag: a mistake.
};

enum class RecordTask { kRecord, kCounts, kStoreCalibration, kInfo, kList };

/// What record_pendulum is to do.
struct RecordPendulumOptions {
  RecordTask task = RecordTask::kRecord;
  std::string port, out;
  std::string calibration;  ///< Path of the calibration to record with, or to store; empty for none.
  std::optional<double> seconds;
  bool until_rest = false, overwrite = false;
  SamplingRate rate;
  unsigned baud = 115200;
  std::optional<FitPendulumOptions> fit;  ///< Of the recording, once it is there; none: no fit.

  /// The files to be written and to be read, with their flags.
  std::vector<NamedFile> Outputs() const;
  std::vector<NamedFile> Inputs() const;
};

/// Checks the flags and turns them into what is to be done. kInvalidArgument: no output, two tasks at once, a flag that
/// does not belong to the task, a rate that no logger has, a number that is none; the message names the flag.
Result<RecordPendulumOptions> MakeRecordPendulumOptions(const RecordPendulumFlags& flags);

/// Samples a second that a line of that baud rate carries at this rate's frames.
double LineCapacityHz(const SamplingRate& rate, unsigned baud);

}  // namespace pendulum
