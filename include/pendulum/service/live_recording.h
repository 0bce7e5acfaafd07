// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/service/http.h"

namespace pendulum {

enum class LiveState {
  kWaiting,    ///< There is no run yet, or its header is incomplete.
  kRecording,  ///< PATH.part exists and was written to in the last minute.
  kEnded,      ///< PATH exists, or PATH.part exists but is no longer written to.
};

/// State of the recording.
struct LiveStatus {
  LiveState state = LiveState::kWaiting;
  std::string name;            ///< File name without folders: of the recording, not of its part file.
  std::uint64_t samples = 0;   ///< Rows so far.
  std::string unit;            ///< "deg" with a calibration, else the unit of the value column, such as "counts".
  std::optional<double> rate;  ///< Hz, from the file's header.
};

/// The recording that record_pendulum --out PATH writes. It is read from PATH.part while it grows and from PATH when it
/// is complete; no other file is opened. Incomplete rows are read later; invalid rows are skipped. The file may be
/// restarted, truncated or deleted at any time, and may be larger than memory. For any thread.
class LiveRecording {
 public:
  explicit LiveRecording(const std::filesystem::path& run);

  /// Reads the appended data, at most some megabytes per call.
  void Poll();

  LiveStatus Status() const;

  /// {"state": "waiting"|"recording"|"ended", "name", "samples", "unit", "rate_hz"|null}, on one line.
  std::string StatusJson() const;

  /// Adds a listener. It polls by itself, twenty times a second for all listeners together, and may outlive this
  /// object. `event: state` has StatusJson; it comes first and after every change. `event: samples` has {"time_s":
  /// [...], "values": [...]}. The first `samples` has the run so far, in at most 4000 points with all its extremes;
  /// later ones have at most 50 points per second of the recording. The state "waiting" means that the plot must be
  /// emptied: it comes before the samples of another run, and if a listener missed samples. The stream never ends by
  /// itself.
  NextEvents Listen();

  /// The file's current bytes up to its last complete line. kNotFound: there is no file. kDataLoss: unreadable, or
  /// larger than 64 MiB.
  Result<std::string> Bytes() const;

 private:
  class Reader;

  std::shared_ptr<Reader> reader_;
};

}  // namespace pendulum
