// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "recording/readers/mat/mat_table.h"

namespace pendulum {

/// MatTable::complaint for a file whose data are in another file.
inline constexpr std::string_view kOtherFile = "another file";

/// Reads the file at this path, which contains these bytes, with matio. matio and the HDF5 library were written for
/// trusted files and crash on some damaged ones, so this must run in a separate process with one thread.
/// A file of version 7.3 may refer to data in any other file. HDF5 would open and read that file, or block if it is a
/// pipe. Therefore this process can open no other file once the given one is open. Objects, which matio does not
/// support, are decoded here (mat_timeseries.h).
MatTable ReadMatTable(const std::string& path, std::string_view bytes);

}  // namespace pendulum
