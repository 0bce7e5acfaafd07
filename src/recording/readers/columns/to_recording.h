// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "pendulum/base/warning.h"
#include "pendulum/recording/clock.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/columns/column_choice.h"
#include "recording/readers/columns/metadata.h"

/// The last step of every reader: converts the numbers of two columns to a Recording.
namespace pendulum::csv {

/// The data that a reader extracts from a file.
struct ReadColumns {
  RawSamples samples;  // N x 1 each, `second` if the layout has it; times are ignored if there is a sample rate.
  Layout layout;
  Metadata metadata;
  bool is_host_time = false;
  std::string sha256;
};

/// A warning of rows that were left out because one of their two cells is empty.
Warning EmptyCells(const std::string& file, std::size_t rows, const std::string& column);

/// Repairs the clock, converts times to seconds and values to SI, and adds warnings.
Result<Recording> ToRecording(ReadColumns columns, const ReadOptions& options);

}  // namespace pendulum::csv
