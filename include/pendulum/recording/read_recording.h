// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "pendulum/recording/recording.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

/// What the user says of a file that it does not say itself.
struct ReadOptions {
  std::string time_column;    ///< Name or 1-based number, both also with :s, :ms or :us; empty: the header's;
                              ///< "none": the times are those of the sample rate.
  std::string value_column;   ///< Name or 1-based number; empty: the header's.
  std::string unit;           ///< Of the values: rad, deg, rad_s, deg_s, counts or volts; empty: the header's.
  double sample_rate_hz = 0;  ///< Of a file without times, Hz; 0: its times, or its `# sample_rate_hz`.
  std::optional<Calibration> calibration;  ///< Of counts or volts; none: the file's own, if it has one.
};

/// Reads a recording from a CSV file; "-" is standard input.
Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from text in memory; `name` stands for the path in messages and in Recording::path. Not kNotFound.
Result<Recording> ParseRecording(std::string_view text, const std::string& name, const ReadOptions& options = {});

}  // namespace pendulum
