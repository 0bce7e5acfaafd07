// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/stat.h>

namespace pendulum {

/// Opens a regular file for reading without blocking; -1 on failure.
int OpenRegularFile(const std::filesystem::path& path);

/// Follows the file that record_pendulum --out PATH writes: PATH.part while it exists, otherwise PATH.
class RunTail {
 public:
  /// New data since the last look.
  struct News {
    bool is_another = false;  ///< The lines come from another file than before, or the file is gone.
    bool has_more = false;    ///< There is more data than one look reads.
    std::string lines;        ///< Complete lines, some megabytes at most.
  };

  explicit RunTail(const std::filesystem::path& run);
  RunTail(const RunTail&) = delete;
  RunTail(RunTail&&) = delete;
  RunTail& operator=(const RunTail&) = delete;
  RunTail& operator=(RunTail&&) = delete;
  ~RunTail();

  News Look();

  /// Whether the part file exists and was written to in the last minute.
  bool is_growing() const { return is_growing_; }

 private:
  /// Attributes of a file in its directory.
  struct FileIdentity {
    std::uintmax_t device, node;
    std::uintmax_t size;  // bytes
    double age;           // s since it was last written
  };

  static std::optional<FileIdentity> IdentityOf(const struct stat& status);
  static std::optional<FileIdentity> Find(const std::filesystem::path& path);
  bool IsSameFile(const FileIdentity& file) const;
  bool Forget();
  void ReadOn(News& news);
  void AppendCompleteLines(std::string_view bytes, std::string& lines);

  std::filesystem::path run_, part_;
  int descriptor_ = -1;  // Descriptor of the followed file.
  bool is_growing_ = false;
  std::uintmax_t offset_ = 0;      // Offset of the next byte.
  std::string head_;               // The first bytes, which identify the run.
  std::string unfinished_;         // A line without its end.
  bool is_line_too_long_ = false;  // The remainder of the line is skipped.
};

}  // namespace pendulum
