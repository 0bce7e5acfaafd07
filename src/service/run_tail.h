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

/// Opens a regular file for reading without waiting for anything; -1 where there is none.
int OpenRegularFile(const std::filesystem::path& path);

/// The file that record_pendulum --out PATH writes, followed: PATH.part while it is there, else PATH.
class RunTail {
 public:
  /// What has come since the last look.
  struct News {
    bool is_another = false;  ///< It belongs to another file than what came before; with no lines, to none.
    bool has_more = false;    ///< There was more than one look takes.
    std::string lines;        ///< Whole lines, some megabytes at most.
  };

  explicit RunTail(const std::filesystem::path& run);
  RunTail(const RunTail&) = delete;
  RunTail(RunTail&&) = delete;
  RunTail& operator=(const RunTail&) = delete;
  RunTail& operator=(RunTail&&) = delete;
  ~RunTail();

  News Look();

  /// Whether the part is there, and was written to within a minute.
  bool is_growing() const { return is_growing_; }

 private:
  /// A file as a directory shows it.
  struct Sight {
    std::uintmax_t device, node;
    std::uintmax_t size;  // bytes
    double age;           // s since it was written to
  };

  static std::optional<Sight> SightOf(const struct stat& status);
  static std::optional<Sight> Find(const std::filesystem::path& path);
  bool IsFollowed(const Sight& file) const;
  bool Forget();
  void ReadOn(News& news);
  void TakeBytes(std::string_view bytes, std::string& lines);

  std::filesystem::path run_, part_;
  int descriptor_ = -1;  // Of the file that is followed.
  bool is_growing_ = false;
  std::uintmax_t offset_ = 0;      // Of the next byte.
  std::string head_;               // The first bytes, which tell one run from another.
  std::string unfinished_;         // A line whose end is not there yet.
  bool is_line_too_long_ = false;  // It is passed over.
};

}  // namespace pendulum
