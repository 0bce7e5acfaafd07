// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "pendulum/base/status.h"

namespace pendulum {

/// A path with letters after it: "out/shard-3.sqlite.part".
std::filesystem::path WithSuffix(const std::filesystem::path& path, const std::string& suffix);

/// kCannotWrite: the folder of the file is not there.
Result<void> CheckFolderOf(const std::filesystem::path& file);

/// Copies a file that nobody writes to, whole or not at all. kNotFound: it is not there. kCannotWrite: as StagedFile.
Result<void> Publish(const std::filesystem::path& from, const std::filesystem::path& to);

/// An SQLite file that goes when this does, unless it was renamed, and its journal: also before, for what a killed
/// process left under the name would be played back into another file.
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
