// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// "cannot write PATH: WHY", kCannotWrite.
tl::unexpected<Status> CannotWrite(const std::string& path, const std::string& why);

/// The system's words for an errno.
std::string SystemWords(int error);

/// The file a path stands for once symbolic links in its last component are followed, whether or not it exists.
std::filesystem::path FollowLinks(std::filesystem::path path);

/// Writes all of it; false with errno where that fails.
bool WriteAll(int descriptor, std::string_view text);

/// Whether a file that has been written survives a loss of power at once, or once its file system is synchronised.
enum class Durability { kSynchronised, kDeferred };

/// A file that is written under a temporary name beside its target, synchronised with the disk, and renamed: whoever
/// looks sees the old file or the whole new one. Removed unless committed. A replaced file keeps its permissions; a
/// symbolic link stays and its target is replaced. kCannotWrite: the system's own words follow the path.
class StagedFile {
 public:
  explicit StagedFile(std::string path, Durability durability = Durability::kSynchronised);
  StagedFile(StagedFile&& other) noexcept;
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  StagedFile& operator=(StagedFile&&) = delete;
  ~StagedFile();

  /// Whether a file of that name is such a temporary one, of a process that lives or was killed.
  static bool IsTemporary(std::string_view name) { return name.starts_with(kPrefix) && name.ends_with(kSuffix); }

  Result<void> Open();

  /// Appends to the open file; may be called often.
  Result<void> Write(std::string_view text);

  /// Puts what was written on the disk, unless that is deferred, and closes it.
  Result<void> Finish();

  /// Gives the finished file its name, and puts that on the disk likewise.
  Result<void> Commit();

 private:
  static constexpr std::string_view kPrefix = ".pendulum.", kSuffix = ".tmp";

  void KeepPermissions() const;

  std::string path_;
  std::filesystem::path target_;
  std::string temporary_;
  Durability durability_;
  int descriptor_ = -1;
};

}  // namespace pendulum
