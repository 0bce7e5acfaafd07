// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/file.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "pendulum/base/try.h"

namespace pendulum {
namespace {

tl::unexpected<Status> Unreadable(const std::string& name) {
  return Fault(name, "the file cannot be read; check its permissions");
}

}  // namespace

InputFile::InputFile(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}

InputFile::InputFile(InputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), name_(std::move(other.name_)) {}

InputFile::~InputFile() {
  if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
}

InputFile InputFile::StandardInput() { return {STDIN_FILENO, "standard input"}; }

Result<InputFile> InputFile::Open(const std::filesystem::path& path, std::string_view kind) {
  std::error_code unknown;
  const std::filesystem::file_type type = std::filesystem::status(path, unknown).type();
  if (type == std::filesystem::file_type::not_found) {
    return ErrorAt(StatusCode::kNotFound, path.string(), "there is no such file; check the path");
  }
  if (type == std::filesystem::file_type::directory) {
    return Fault(path.string(), "this is a directory; name a " + std::string(kind) + " file in it");
  }
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Unreadable(path.string());
  return InputFile(descriptor, path.string());
}

Result<std::size_t> InputFile::Read(std::span<char> room) {
  std::size_t used = 0;
  while (used < room.size()) {
    const ssize_t got = ::read(descriptor_, room.data() + used, room.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Unreadable(name_);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  return used;
}

Result<std::string> ReadFile(const std::filesystem::path& path, std::string_view kind, std::uintmax_t max_bytes) {
  constexpr std::uintmax_t kBlock = 65536;
  Result<InputFile> file = InputFile::Open(path, kind);
  if (!file) return tl::unexpected(file.error());
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  std::string bytes(std::min(unknown ? kBlock : size, max_bytes) + 1, '\0');  // One more byte detects the end.
  std::size_t used = 0;
  while (true) {
    ASSIGN_OR_RETURN(const std::size_t got, file->Read(std::span(bytes).subspan(used)));
    used += got;
    if (used < bytes.size() || used > max_bytes) break;
    bytes.resize(std::min<std::uintmax_t>(2 * used, max_bytes + 1));
  }
  if (used > max_bytes) {
    return Fault(path.string(), "the file has more than " + std::to_string(max_bytes) + " bytes, too many for a " +
                                    std::string(kind) + " file; give a smaller file, or split it");
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace pendulum
