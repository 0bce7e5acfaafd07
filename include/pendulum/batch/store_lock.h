// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "pendulum/base/status.h"

namespace pendulum {

/// Keeps other processes of this machine from refitting or merging into one store at the same time: a lock on
/// STORE.lock, a file that goes with the lock. Whoever is killed holds nothing. Readers need none.
class StoreLock {
 public:
  /// kTryAgain: another process has it. kCannotWrite: the file beside the store cannot be made.
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
