// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// An error kCannotWrite with the message "cannot write PATH: WHY".
tl::unexpected<Status> CannotWrite(const std::string& path, const std::string& why);

/// The operating system's message for an errno.
std::string SystemErrorText(int error);

/// The file that a path refers to after symbolic links in its last component are followed. The file need not exist.
std::filesystem::path FollowLinks(std::filesystem::path path);

/// Writes all of `text`. Returns false, with errno set, on failure.
bool WriteAll(int descriptor, std::string_view text);

/// Whether a written file survives a loss of power immediately, or only after its file system has been synchronised.
enum class Durability { kSynchronised, kDeferred };

/// A file that is written under a temporary name beside its target, synchronised with the disk, and then renamed.
/// Readers see either the old file or the complete new one. The temporary file is removed unless committed. A replaced
/// file keeps its permissions. A symbolic link stays and its target is replaced. kCannotWrite: the path and the
/// system's message.
class StagedFile {
 public:
  explicit StagedFile(std::string path, Durability durability = Durability::kSynchronised);
  StagedFile(StagedFile&& other) noexcept;
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  StagedFile& operator=(StagedFile&&) = delete;
  ~StagedFile();

  /// Whether `name` is the name of such a temporary file. Its writer may still run or may have been killed.
  static bool IsTemporary(std::string_view name) { return name.starts_with(kPrefix) && name.ends_with(kSuffix); }

  Result<void> Open();

  /// Appends to the open file. May be called repeatedly.
  Result<void> Write(std::string_view text);

  /// Synchronises the written data with the disk, unless that is deferred, and closes the file.
  Result<void> Finish();

  /// Renames the finished file to its target and synchronises the folder, unless that is deferred.
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
