// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// The incomplete recording on disk, named PATH.part. It can be read at any time, so a crash or a loss of power costs
/// at most a second of data. A stream has no part file.
class PartFile {
 public:
  /// `path`: final path of the recording; empty: none.
  explicit PartFile(const std::string& path);
  PartFile(const PartFile&) = delete;
  PartFile(PartFile&&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  PartFile& operator=(PartFile&&) = delete;
  ~PartFile();

  /// Whether the part of an earlier recording exists.
  bool Exists() const;

  /// Creates it or empties it. kCannotWrite.
  Result<void> Open();

  /// kCannotWrite.
  Result<void> Append(std::string_view text);

  /// Writes the appended text to the disk. kCannotWrite.
  Result<void> Synchronise();

  /// Call it when the complete recording is written.
  void Remove();

  const std::string& path() const { return path_; }

 private:
  std::string path_;  // empty for a stream
  int descriptor_ = -1;
};

}  // namespace pendulum
