// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/file.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace pendulum {

Result<std::string> ReadFile(const std::filesystem::path& path, std::string_view kind, std::uintmax_t most_bytes) {
  constexpr std::uintmax_t kBlock = 65536;
  const auto fault = [&](const std::string& sentence) {
    return Error(StatusCode::kDataLoss, path.string() + ": " + sentence);
  };
  std::error_code unknown;
  const std::filesystem::file_type type = std::filesystem::status(path, unknown).type();
  if (type == std::filesystem::file_type::not_found) {
    return Error(StatusCode::kNotFound, path.string() + ": there is no such file; check the path");
  }
  if (type == std::filesystem::file_type::directory) {
    return fault("this is a directory; name a " + std::string(kind) + " file in it");
  }
  std::ifstream file(path, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  std::string bytes(std::min(unknown ? kBlock : size, most_bytes) + 1, '\0');  // The extra byte finds the end.
  std::size_t used = 0;
  while (file.read(bytes.data() + used, static_cast<std::streamsize>(bytes.size() - used))) {
    used = bytes.size();
    if (used > most_bytes) break;
    bytes.resize(std::min<std::uintmax_t>(2 * used, most_bytes + 1));
  }
  if (!file.is_open() || file.bad()) return fault("the file cannot be read; check its permissions");
  if (used > most_bytes) {
    return fault("the file has more than " + std::to_string(most_bytes) + " bytes, too many for a " +
                 std::string(kind) + " file; name another, or split it");
  }
  bytes.resize(used + static_cast<std::size_t>(file.gcount()));
  return bytes;
}

}  // namespace pendulum
