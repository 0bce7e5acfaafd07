// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "pendulum/recording/clock.h"
#include "pendulum/recording/readers/columns/table_preview.h"
#include "pendulum/recording/recording.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// Information from the user that the file itself does not give.
struct ReadOptions {
  /// Name or 1-based number, optionally with :s, :ms or :us; "none": use the sample rate; empty: use the header.
  std::string time_column;
  std::string value_column;   ///< Name or 1-based number; "x,y": both coordinates of a point; empty: use the header.
  std::string unit;           ///< Of the values, as a suffix in the header: rad, m_s2 ...; empty: use the header.
  double sample_rate_hz = 0;  ///< For a file without times, Hz; 0: use its times, or its `# sample_rate_hz`.
  std::optional<Calibration> calibration;  ///< For counts or volts; std::nullopt: the file's own, if any.
  std::optional<double> resolution;        ///< In the file's unit; 0: continuous; std::nullopt: the file's.
  std::optional<SensorRange> range;        ///< The sensor's range, in the file's unit; std::nullopt: the file's own.
  int oversample = 0;                      ///< Readings in a mean, 1 to kMostOversampling; 0: as the file says.
  std::optional<AveragingWindow> averaging_window;  ///< std::nullopt: the file's own.
  ClockWindow window = {};  ///< The part that is used: its clock may be right if that of the file is not.
  /// Limit for a member of a zip file, for all columns of a MAT-file and for all sheets of a workbook as text, which
  /// may be a thousand times larger than the file.
  std::size_t most_unpacked_bytes = std::size_t{1} << 29;
  TablePreview* preview = nullptr;  ///< Receives the table, also if reading fails; nullptr: not wanted.
};

}  // namespace pendulum
