// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "recording/readers/mat/mat_table.h"

namespace pendulum {

/// The complaint about a file whose data stand in another one.
inline constexpr std::string_view kOtherFile = "another file";

/// Reads the file at this path, which has these bytes, by matio, which was written for files of friends: it and the
/// HDF5 library below it crash on some that are damaged, so this is called in a process of its own. Both are for one
/// thread. A file of version 7.3 may say that its data stand in any other file, which HDF5 would open and read, or wait
/// for where it is a pipe: so once this one is open, the process opens no more, ever. Objects, which matio does not
/// know, are taken apart here (mat_timeseries.h).
MatTable ReadMatTable(const std::string& path, std::string_view bytes);

}  // namespace pendulum
