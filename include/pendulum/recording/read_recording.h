// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/recording/recording.h"

namespace pendulum {

/// Reads a recording from a CSV file.
///
/// The first line that is neither blank nor a comment names the columns. One column is time (`time_s`, `time_ms`,
/// `time_us`), exactly one is the quantity, told by its unit suffix: `_rad`, `_deg` (angle), `_rad_s`, `_deg_s` (rate);
/// `Time (ms)` and `Gyro [rad/s]` say the same. `_counts`, `_volts`, `_m_s2` and `_px` are quantities too, refused for
/// want of a calibration. Other columns are ignored. Separator: comma, semicolon or tab, whichever the header uses
/// most. A byte order mark, CRLF, blanks around fields and double quotes are accepted; a row may hold no more fields
/// than the header.
///
/// `#` starts a comment line. `# key: value` is metadata, each key once: `resolution` gives the spacing of values and
/// `range` the two ends of what the sensor can show, in the file's unit; `sample_rate_hz`, `clock_scale`,
/// `clock_scale_std_dev`, `lost_samples`, `calibration` and `rig` are checked for their form and not used: a warning
/// `metadata_not_applied` names those that would change the numbers. Any other key is a comment. A gap in time is
/// ordinary.
///
/// kNotFound: no such file. kDataLoss: not readable as above. kFailedPrecondition: fewer than kMinimumSamples rows, or
/// none because the file is empty. Every message begins "path:line:column: " (1-based, bytes), or "path: " when the
/// file could not be opened or read at all. Cost: one pass over the bytes, no copy of a field.
Result<Recording> ReadRecording(const std::filesystem::path& path);

/// The same from text in memory; `name` stands for the path in messages and in Recording::path. Not kNotFound.
Result<Recording> ParseRecording(std::string_view text, const std::string& name);

}  // namespace pendulum
