// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Reads a recording from a file; "-" is standard input. The format is detected from the content: CSV in UTF-8 or
/// UTF-16, including exports of phyphox, Tracker, Logger Pro, Graphical Analysis, Capstone and ROS; a zip file that
/// contains one of these (--value_column "FILE/COLUMN" selects one); a MAT-file of version 4 to 7.3; a workbook (.xlsx,
/// .xlsm, .xls, .ods, .fods, XML of Excel 2003) with the recording in one sheet ("SHEET/COLUMN"); a saved state of
/// phyphox; arrays of NumPy (.npy, .npz); JSON (arrays, objects, one object on each line). Other formats are named,
/// with how to export from them. Cost: one pass, 16 bytes per row and one block. Files other than text are held in
/// memory completely; MAT-files, workbooks and states of phyphox are read in a separate process.
///
/// The tables of workbooks, JSON and arrays are read as if they were CSV; dates and times of day become text, and cells
/// with errors are empty. In messages, "path:SHEET:12:" is row 12 of the sheet.
///
/// In text, the table begins with the first rows of numbers, and the names are above them. Time and quantity are found
/// by the words and units in the names, in several languages; else by their numbers (column_choice.h). What is assumed
/// is a warning that names the flag which says otherwise. An error lists all that is missing; Status::try_flags has
/// flags that would help. With several runs, the chosen column uses the time of its run.
/// Separators: comma, semicolon, tab, blanks, or the one in a line `sep=;`; decimal commas if the separator is not a
/// comma. A byte order mark, CRLF, quotes and the time stamps of a serial monitor are accepted. `# key: value` is
/// metadata, each key once: `resolution` and `range` in the file's unit, `sample_rate_hz` (for rows without time),
/// `clock_scale`, `clock_scale_std_dev`, `lost_samples`, `oversample` and `window_s` (the rows are means, and over
/// which window), `calibration` and `rig` (JSON). Other lines with # are
/// comments. If no resolution is given, it is estimated from the values (FindResolution). Counts that repeatedly reach
/// 0 or the full scale of 10, 12, 14 or 16 bits have this range.
///
/// Warnings: those of RepairClock; incomplete_row, empty_cells, sample_rate_from_text, notes_left_out, stray_lines (no
/// rows between rows), text_below_table, second_table, host_time, lost_samples; time_column_assumed, time_unit_assumed,
/// times_of_day, value_column_assumed, value_unit_assumed, axes_combined; unreadable_member (in a zip file);
/// member_assumed (several sheets); metadata_not_applied (a calibration in a file of angles). kNotFound: no such file.
/// kDataLoss: not readable as above, or a calibration of another unit. kInvalidArgument: the options contradict the
/// file. kFailedPrecondition: fewer than kMinimumSamples rows. kTryAgain: no process or no room for a MAT-file or a
/// workbook. Messages begin "path:line:", or "path:".
Result<Recording> ReadRecording(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same from bytes in memory; `name` replaces the path in messages and in Recording::path. Never returns kNotFound.
Result<Recording> ParseRecording(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

}  // namespace pendulum
