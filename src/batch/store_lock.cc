// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/store_lock.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pendulum/base/staged_file.h"

namespace pendulum {
namespace {

/// Whether the path still refers to the open file; the previous owner of the lock may have removed the file.
bool IsStillThere(const std::string& path, int descriptor) {
  struct stat named {};
  struct stat open {};
  return ::stat(path.c_str(), &named) == 0 && ::fstat(descriptor, &open) == 0 && named.st_ino == open.st_ino &&
         named.st_dev == open.st_dev;
}

}  // namespace

StoreLock::StoreLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

StoreLock::StoreLock(StoreLock&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

StoreLock::~StoreLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

Result<StoreLock> StoreLock::Take(const std::filesystem::path& store) {
  const std::string path = FollowLinks(store).string() + ".lock";
  while (true) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) return CannotWrite(store.string(), SystemErrorText(errno) + " (" + path + ")");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      ::close(descriptor);
      return ErrorAt(StatusCode::kTryAgain, store.string(),
                     "another process writes to this file; try again when it is done");
    }
    if (IsStillThere(path, descriptor)) return StoreLock(path, descriptor);
    ::close(descriptor);
  }
}

}  // namespace pendulum
