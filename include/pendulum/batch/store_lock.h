// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// Prevents other processes of this machine from refitting or merging into the same store. It locks the file
/// STORE.lock, and removes this file at the end. The lock of a killed process is released. Readers need no lock.
class StoreLock {
 public:
  /// kTryAgain: another process holds it. kCannotWrite: the lock file cannot be created.
  static Result<StoreLock> Take(const std::filesystem::path& store);

  StoreLock(StoreLock&& other) noexcept;
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;
  StoreLock& operator=(StoreLock&&) = delete;
  ~StoreLock();

 private:
  StoreLock(std::string path, int descriptor);

  std::string path_;
  int descriptor_;
};

}  // namespace pendulum
