// SPDX-License-Identifier: Apache-2.0
#include "tools/part_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "pendulum/base/staged_file.h"
#include "tools/output.h"

namespace pendulum {
namespace {

constexpr int kReadAndWrite = 0666;  // before the umask is applied

bool IsFileOrAbsent(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  return status.type() == std::filesystem::file_type::not_found || std::filesystem::is_regular_file(status);
}

}  // namespace

PartFile::PartFile(const std::string& path)
    : path_(!path.empty() && !IsStandardOutput(path) && IsFileOrAbsent(path) ? path + ".part" : "") {}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool PartFile::Exists() const {
  std::error_code error;
  return !path_.empty() && std::filesystem::exists(path_, error);
}

Result<void> PartFile::Open() {
  if (path_.empty()) return {};
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadAndWrite);
  if (descriptor_ < 0) return CannotWrite(path_, SystemErrorText(errno));
  return {};
}

Result<void> PartFile::Append(std::string_view text) {
  if (descriptor_ < 0 || WriteAll(descriptor_, text)) return {};
  return CannotWrite(path_, SystemErrorText(errno));
}

Result<void> PartFile::Synchronise() {
  if (descriptor_ < 0 || ::fdatasync(descriptor_) == 0) return {};
  return CannotWrite(path_, SystemErrorText(errno));
}

void PartFile::Remove() {
  std::error_code error;
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!path_.empty()) std::filesystem::remove(path_, error);
}

}  // namespace pendulum
