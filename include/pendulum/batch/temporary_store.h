// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "pendulum/base/status.h"

namespace pendulum {

/// A path with a suffix: "out/shard-3.sqlite.part".
std::filesystem::path WithSuffix(const std::filesystem::path& path, const std::string& suffix);

/// kCannotWrite: the folder of the file does not exist.
Result<void> CheckFolderOf(const std::filesystem::path& file);

/// Copies a file that nobody writes to, completely or not at all. kNotFound: no such file. kCannotWrite: as StagedFile.
Result<void> Publish(const std::filesystem::path& from, const std::filesystem::path& to);

/// An SQLite file that is removed at the end, with its journal, unless it was renamed. An old file and journal are also
/// removed at the beginning: SQLite would apply a journal left by a killed process to the new file.
class TemporaryStore {
 public:
  explicit TemporaryStore(std::filesystem::path path) : path_(std::move(path)) { Remove(); }
  TemporaryStore(TemporaryStore&&) = delete;
  TemporaryStore(const TemporaryStore&) = delete;
  TemporaryStore& operator=(TemporaryStore&&) = delete;
  TemporaryStore& operator=(const TemporaryStore&) = delete;
  ~TemporaryStore() { Remove(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  void Remove() const;

  std::filesystem::path path_;
};

}  // namespace pendulum
