// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"

namespace pendulum {

/// A file open for reading. It may be a pipe.
class InputFile {
 public:
  /// `kind` is the expected kind of file; messages say "a <kind> file". kNotFound: no such file. kDataLoss: the path is
  /// a directory, or the file cannot be opened.
  static Result<InputFile> Open(const std::filesystem::path& path, std::string_view kind);

  /// Standard input. Messages call it "standard input".
  static InputFile StandardInput();

  InputFile(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  /// Waits until `room` is full or the file ends. Returns the number of bytes read. kDataLoss: the file cannot be read.
  Result<std::size_t> Read(std::span<char> room);

  const std::string& name() const { return name_; }

 private:
  InputFile(int descriptor, std::string name);

  int descriptor_;
  std::string name_;
};

/// Reads a whole file, which may be a pipe. `kind` is the expected kind of file; messages say "a <kind> file".
/// kNotFound: there is no such file. kDataLoss: it is a directory, cannot be read or has more than `max_bytes`.
Result<std::string> ReadFile(const std::filesystem::path& path, std::string_view kind, std::uintmax_t max_bytes);

}  // namespace pendulum
