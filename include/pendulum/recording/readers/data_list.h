// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

struct ListedFile {
  std::filesystem::path path;  ///< Relative paths in the list start at the folder of the list.
  std::string place;           ///< "list:line", for messages about this file.
};

/// Reads a list of recordings: one path per line; blank lines and # lines are ignored. "-" is standard input, whose
/// paths are relative to the current folder. kNotFound: no such list, or no such file named in it (list:line).
/// kDataLoss: the list cannot be read, is not text, names a directory, or names one file twice (list:line).
/// kFailedPrecondition: it names no file.
Result<std::vector<ListedFile>> ReadDataList(const std::filesystem::path& path);

}  // namespace pendulum
