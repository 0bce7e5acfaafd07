// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/recording/readers/columns/line_reader.h"
#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/columns/table.h"

namespace pendulum {

/// Reads a recording from rows of text: ReadRecording for all that is text. One pass, one block in memory.
Result<Recording> ReadRows(LineReader lines, const ReadOptions& options);

/// The columns that a text's first lines name, none without a header. kDataLoss: as ReadRows, as far as these lines go.
Result<std::vector<csv::TableColumn>> ReadColumnNames(LineReader lines);

}  // namespace pendulum
