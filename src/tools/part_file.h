// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// What is there of a recording while it is being made: beside its place under the name PATH.part, a recording that can
/// be read at any time, so that neither a crash nor a loss of power loses more than a second. Nothing for a stream.
class PartFile {
 public:
  /// `path`: where the whole recording will be; empty for nowhere.
  explicit PartFile(const std::string& path);
  PartFile(const PartFile&) = delete;
  PartFile(PartFile&&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  PartFile& operator=(PartFile&&) = delete;
  ~PartFile();

  /// Whether the part of an earlier recording is there.
  bool Exists() const;

  /// Begins it anew. kCannotWrite.
  Result<void> Open();

  /// kCannotWrite.
  Result<void> Append(std::string_view text);

  /// Puts what was appended on the disk. kCannotWrite.
  Result<void> Synchronise();

  /// Once the whole is there.
  void Remove();

  const std::string& path() const { return path_; }

 private:
  std::string path_;  // empty for a stream
  int descriptor_ = -1;
};

}  // namespace pendulum
