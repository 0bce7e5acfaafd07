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
  kWaiting,    ///< There is no run yet, or not its header.
  kRecording,  ///< PATH.part is there and has been written to within a minute.
  kEnded,      ///< PATH is there, or its part that nobody writes to any more.
};

/// Where the recording stands.
struct LiveStatus {
  LiveState state = LiveState::kWaiting;
  std::string name;            ///< Of its file, without folders; that of the recording, not of its part.
  std::uint64_t samples = 0;   ///< Rows so far.
  std::string unit;            ///< Of the values: "deg" where the file has a calibration, else the column's: "counts".
  std::optional<double> rate;  ///< Hz, as the file says.
};

/// The recording that record_pendulum --out PATH is making, read from PATH.part while it grows and from PATH once it is
/// whole; nothing else is ever opened. Rows that are not whole yet are left for later, rows that are none are passed
/// over. The file may be begun anew, cut off or vanish at any time, and be larger than memory. For any thread.
class LiveRecording {
 public:
  explicit LiveRecording(const std::filesystem::path& run);

  /// Reads what has been appended since, at most some megabytes of it.
  void Poll();

  LiveStatus Status() const;

  /// {"state": "waiting"|"recording"|"ended", "name", "samples", "unit", "rate_hz"|null}, on one line.
  std::string StatusJson() const;

  /// A listener of its own, which polls by itself, twenty times a second for all listeners together, and may outlive
  /// this object. `event: state` has StatusJson, first of all and whenever that changes; `event: samples` has
  /// {"time_s": [...], "values": [...]}: first the run so far, in at most 4000 points with all its extremes, then what
  /// follows, at most 50 points for each of its seconds. A state that is waiting empties the plot: it comes before the
  /// samples of another run, and where a listener lost the thread. It never ends by itself.
  NextEvents Listen();

  /// The file as it is now, up to its last whole line. kNotFound: there is none yet. kDataLoss: unreadable, or larger
  /// than 64 MiB.
  Result<std::string> Bytes() const;

 private:
  class Reader;

  std::shared_ptr<Reader> reader_;
};

}  // namespace pendulum
