// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Where bytes come from: a zip file in a zip file is not unpacked, unless it is a workbook or contains arrays.
enum class Nesting { kFile, kMember };

/// Reads a recording from bytes in memory, whatever their format.
Result<Recording> ReadBytes(std::string_view bytes, const std::string& name, const ReadOptions& options,
                            Nesting nesting);

}  // namespace pendulum
