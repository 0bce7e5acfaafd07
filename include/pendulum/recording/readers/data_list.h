// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pendulum/base/status.h"

namespace pendulum {

struct ListedFile {
  std::filesystem::path path;  ///< Relative paths begin at the folder of the list.
  std::string place;           ///< "list:line", for messages about it.
};

/// Reads a list of recordings: one path a line, blank lines and # lines left out; "-" is standard input, relative to
/// the current folder. kNotFound: there is no such list, or none of a file that it names (list:line). kDataLoss: it
/// cannot be read, is no text, names a directory or one file twice (list:line). kFailedPrecondition: it names no file.
Result<std::vector<ListedFile>> ReadDataList(const std::filesystem::path& path);

}  // namespace pendulum
