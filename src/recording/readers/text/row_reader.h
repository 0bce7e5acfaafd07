// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/recording/readers/columns/line_reader.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/columns/table.h"

namespace pendulum {

/// Implements ReadRecording for text. Reads the text once and keeps one block of it in memory.
Result<Recording> ReadRows(LineReader lines, const ReadOptions& options);

/// As ReadRows, for lists that became the columns of a text. kDataLoss: time and reading have different lengths, so
/// nothing says which of their numbers belong together.
Result<Recording> ReadLists(LineReader lines, const ReadOptions& options);

/// The columns named in the first lines of a text; empty without a header. Errors as ReadRows.
Result<std::vector<csv::TableColumn>> ReadColumnNames(LineReader lines);

}  // namespace pendulum
