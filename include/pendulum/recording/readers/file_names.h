// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pendulum {

/// Whether the ending of a file's name, in lower or upper case, is one that recordings have ("csv", "xlsx"). A search
/// of folders needs this; a file that is named is read whatever its name. JSON is not among them, because most such
/// files are rigs and results.
bool HasRecordingName(std::string_view name);

/// "*.csv, *.dat, ..., *.xlsx and *.zip".
std::string RecordingNames();

}  // namespace pendulum
