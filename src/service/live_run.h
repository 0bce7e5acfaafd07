// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string_view>
#include <vector>

#include "service/live_points.h"
#include "service/live_rows.h"

namespace pendulum {

/// The part of a run that was read so far.
struct LiveRun {
  static constexpr std::size_t kMaxLatest = 4000;  // 80 s of points; a listener that is further behind restarts

  LiveRows rows;
  WholeRun whole;
  SparsePoints sparse;
  std::deque<LivePoint> latest;
  std::uint64_t samples = 0;
  std::uint64_t latest_begin = 0;  // number of the first point in `latest`

  std::uint64_t latest_end() const { return latest_begin + latest.size(); }

  void AppendLatest(const std::vector<LivePoint>& points) {
    latest.insert(latest.end(), points.begin(), points.end());
    for (; latest.size() > kMaxLatest; ++latest_begin) latest.pop_front();
  }

  void Read(std::string_view lines) {
    std::vector<LivePoint> settled;
    while (!lines.empty()) {
      const std::string_view line = lines.substr(0, lines.find('\n'));
      lines.remove_prefix(std::min(lines.size(), line.size() + 1));
      const auto point = rows.Read(line);
      if (!point) continue;
      ++samples;
      whole.Add(*point);
      sparse.Add(*point, settled);
    }
    AppendLatest(settled);
  }

  /// Appends the points of the unfinished block. Call it if no more samples arrive.
  void FlushPoints() {
    std::vector<LivePoint> settled;
    sparse.Flush(settled);
    AppendLatest(settled);
  }
};

}  // namespace pendulum
