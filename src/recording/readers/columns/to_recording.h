// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "pendulum/recording/clock.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/metadata.h"

/// The last step of every reader: from the numbers of two columns to a Recording.
namespace pendulum::csv {

/// What a reader has of a file.
struct ReadColumns {
  RawSamples samples;  // N x 1 each, `second` where the layout has it; the times are not looked at where the sample
                       // rate tells them.
  Layout layout;
  Metadata metadata;
  bool is_host_time = false;
  std::string sha256;
};

/// Of rows that were left out because one of their two cells is empty.
Warning EmptyCells(const std::string& file, std::size_t rows, const std::string& column);

/// Seconds from a clock that is repaired, values in SI, and what there is to be warned of. `line` is that of the names.
Result<Recording> ToRecording(ReadColumns columns, const Line& line, const ReadOptions& options);

}  // namespace pendulum::csv
