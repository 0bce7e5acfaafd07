// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Reads a recording from a file; "-" is standard input. What it is its content tells: CSV, also as phyphox, Tracker,
/// Logger Pro, Graphical Analysis, Capstone and ROS export it; a zip file with one of these in it (--value_column
/// "FILE/COLUMN" names one); a MAT-file of version 4 to 7.3. Cost: one pass, 16 bytes a row and one block; zip and MAT
/// files are in memory as a whole, and a MAT-file is read in a process of its own.
///
/// In CSV the first line names the columns: time `time_s`, `time_ms` or `time_us`, the quantity by its suffix `_rad`,
/// `_deg`, `_rad_s`, `_deg_s`, `_counts` or `_volts`; `Time (ms)` says the same. What is not told, or told twice, is
/// for ReadOptions to say; of several runs the column chosen comes with its own time. Separators: comma, semicolon,
/// tab, blanks, or that of `sep=;`; decimal commas where the separator is none. A byte order mark, CRLF, quotes and the
/// stamps of a serial monitor are accepted. `# key: value` is metadata, each key once: `resolution` and `range` in the
/// file's unit, `sample_rate_hz` (for rows without time), `clock_scale`, `clock_scale_std_dev`, `lost_samples`,
/// `calibration` and `rig` (JSON). Other lines with # are comments. A resolution that nobody tells is looked for in the
/// values (FindResolution), and counts that end at 0 or the full scale of 10, 12, 14 or 16 bits have that range.
///
/// Warnings: those of RepairClock; incomplete_row, empty_cells, host_time, time_unit_assumed, lost_samples;
/// unreadable_member, of a zip file; metadata_not_applied, a calibration in a file of angles. kNotFound: no such file.
/// kDataLoss: not readable as above, or a calibration of another unit. kInvalidArgument: the options contradict the
/// file. kFailedPrecondition: fewer than kMinimumSamples rows. kTryAgain: no process or no room for a MAT-file.
/// Messages begin "path:line:", or "path:".
Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from bytes in memory; `name` stands for the path in messages and in Recording::path. Not kNotFound.
Result<Recording> ParseRecording(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

}  // namespace pendulum
