// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "pendulum/recording/sensor.h"

namespace pendulum {

/// What the user says about a file in addition to its contents.
struct ReadOptions {
  /// Name or 1-based number, both also with :s, :ms or :us; "none": those of the sample rate; empty: the header's.
  std::string time_column;
  std::string value_column;   ///< Name or 1-based number; empty: the header's.
  std::string unit;           ///< Of the values, as a suffix of the header: rad, m_s2 ...; empty: the header's.
  double sample_rate_hz = 0;  ///< Of a file without times, Hz; 0: its times, or its `# sample_rate_hz`.
  std::optional<Calibration> calibration;  ///< Of counts or volts; none: the file's own, if it has one.
  std::optional<double> resolution;        ///< Spacing of the values, in the file's unit; 0: none; absent: the file's.
  std::optional<SensorRange> range;        ///< What the sensor can show, in the file's unit; absent: the file's own.
  /// Of a member of a zip file, or of all columns of a MAT-file, which may be a thousand times as large as the file.
  std::size_t most_unpacked_bytes = std::size_t{1} << 29;
};

}  // namespace pendulum
