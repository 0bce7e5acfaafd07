// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/staged_file.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pendulum {

namespace fs = std::filesystem;

std::string SystemErrorText(int error) { return std::generic_category().message(error); }

tl::unexpected<Status> CannotWrite(const std::string& path, const std::string& why) {
  return Error(StatusCode::kCannotWrite, "cannot write " + path + ": " + why);
}

fs::path FollowLinks(fs::path path) {
  constexpr int kMaxLinks = 40;  // The kernel has the same limit.
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // If the target is absolute, `/` returns the target alone.
  }
  return path;
}

bool WriteAll(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

StagedFile::StagedFile(std::string path, Durability durability)
    : path_(std::move(path)), target_(FollowLinks(path_)), durability_(durability) {}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      durability_(other.durability_),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

StagedFile::~StagedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<void> StagedFile::Open() {
  const fs::path directory = target_.has_parent_path() ? target_.parent_path() : ".";
  while (descriptor_ < 0) {
    // A killed process with the same number may have left a file of this name. Then the next name is tried.
    static std::atomic<std::uint64_t> names = 0;
    std::string name(kPrefix);
    name.append(std::to_string(::getpid()) + "." + std::to_string(names++)).append(kSuffix);
    const std::string temporary = directory / name;
    descriptor_ = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) {
      temporary_ = temporary;
    } else if (errno != EEXIST) {
      break;
    }
  }
  if (descriptor_ < 0) return CannotWrite(path_, SystemErrorText(errno));
  KeepPermissions();
  return {};
}

Result<void> StagedFile::Write(std::string_view text) {
  if (!WriteAll(descriptor_, text)) return CannotWrite(path_, SystemErrorText(errno));
  return {};
}

Result<void> StagedFile::Finish() {
  if (durability_ == Durability::kSynchronised && ::fsync(descriptor_) != 0) {
    return CannotWrite(path_, SystemErrorText(errno));
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) return CannotWrite(path_, SystemErrorText(errno));
  return {};
}

Result<void> StagedFile::Commit() {
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return CannotWrite(path_, SystemErrorText(errno));
  temporary_.clear();
  if (durability_ == Durability::kDeferred) return {};
  // Synchronise the folder so that the name survives a loss of power. Failure is ignored: some folders cannot be opened
  // or synchronised.
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return {};
  ::fsync(descriptor);
  ::close(descriptor);
  return {};
}

/// Copies the mode of the replaced file, and its owner where permitted.
void StagedFile::KeepPermissions() const {
  constexpr mode_t kPermissions = 07777;
  struct stat old {};
  if (::stat(target_.c_str(), &old) != 0) return;
  const bool owned = ::fchown(descriptor_, old.st_uid, old.st_gid) == 0;
  ::fchmod(descriptor_, old.st_mode & (owned ? kPermissions : 0777U));
}

}  // namespace pendulum
