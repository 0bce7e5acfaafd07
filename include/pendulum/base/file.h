// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// Every byte of a file, which may be a pipe. `kind` says what it should be: "a <kind> file".
///
/// kNotFound: there is no such file. kDataLoss: it is a directory, cannot be read or has more than `most_bytes`.
Result<std::string> ReadFile(const std::filesystem::path& path, std::string_view kind, std::uintmax_t most_bytes);

}  // namespace pendulum
