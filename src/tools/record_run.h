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

/// Why a recording ended.
enum class RunEnd {
  kSeconds,  ///< It is as long as was asked for.
  kRest,     ///< The pendulum has come to rest.
  kStopped,  ///< A signal asked for it.
  kLost,     ///< The logger is gone.
};

/// A run that was recorded, whole or as far as it came.
struct RecordedRun {
  explicit RecordedRun(const SamplingRate& rate) : run(rate) {}

  RunDescription description;
  ReceivedRun run;  ///< No more of it than was asked for.
  RunEnd end = RunEnd::kStopped;
  std::string why_lost;      ///< A sentence, of kLost.
  int damaged_frames = 0;    ///< Pieces of what came that were no frame.
  std::string part_trouble;  ///< Why there is no copy on the disk; empty where there is one.

  /// The file's text.
  std::string Csv() const;
};

inline constexpr std::string_view kRecordToolName = "record_pendulum";

/// Starts the connected logger, records until the run is to end, or `stop` is true, and stops it. Meanwhile what has
/// come is in a PartFile, and a live trace is drawn on standard error where that is a terminal, else said now and then.
/// Losing the logger ends the run; what came before is kept. kDataLoss: nothing came at all. kTryAgain: stopped before
/// anything came.
Result<RecordedRun> RecordRun(const RecordPendulumOptions& options, const pendulum_logger::Info& info,
                              const std::optional<Calibration>& calibration, const std::atomic<bool>& stop,
                              Logger& logger);

}  // namespace pendulum
