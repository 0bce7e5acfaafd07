// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "pendulum/acquisition/logger.h"
#include "pendulum/acquisition/received_run.h"
#include "pendulum/acquisition/run_csv.h"
#include "pendulum/base/status.h"
#include "pendulum/recording/sensor.h"
#include "tools/record_pendulum_options.h"

namespace pendulum {

/// The reason why a recording ended.
enum class RunEnd {
  kSeconds,  ///< It has the requested length.
  kRest,     ///< The pendulum is at rest.
  kStopped,  ///< A signal stopped it.
  kLost,     ///< The connection to the logger is lost.
};

/// A recorded run, complete or up to an interruption.
struct RecordedRun {
  explicit RecordedRun(const SamplingRate& rate) : run(rate) {}

  RunDescription description;
  ReceivedRun run;  ///< Samples up to the requested length.
  RunEnd end = RunEnd::kStopped;
  std::string loss_reason;      ///< A sentence for kLost.
  int damaged_frames = 0;       ///< Received pieces that were not valid frames.
  std::string part_file_error;  ///< Why the part file is missing or incomplete; empty if it is complete.

  /// The recording as CSV text.
  std::string Csv() const;
};

inline constexpr std::string_view kRecordToolName = "record_pendulum";

/// Starts the connected logger, records until the end of the run or until `stop` is true, and stops the logger. During
/// the run the data is written to a PartFile. If standard error is a terminal, a live trace is drawn on it; otherwise
/// the progress is printed from time to time. Losing the logger ends the run and keeps the data. kDataLoss: no data
/// arrived. kTryAgain: stopped before data arrived.
Result<RecordedRun> RecordRun(const RecordPendulumOptions& options, const pendulum_logger::Info& info,
                              const std::optional<Calibration>& calibration, const std::atomic<bool>& stop,
                              Logger& logger);

}  // namespace pendulum
