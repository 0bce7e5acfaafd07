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

/// kDataLoss: what is wrong in a file, which the sentence will name first.
tl::unexpected<Status> Fault(const std::string& name, const std::string& sentence);

/// A file that is open for reading, which may be a pipe.
class InputFile {
 public:
  /// `kind`: what it should be, "a <kind> file". kNotFound: no such file. kDataLoss: a directory, or it cannot be
  /// opened.
  static Result<InputFile> Open(const std::filesystem::path& path, std::string_view kind);

  /// Standard input, "standard input" in messages.
  static InputFile StandardInput();

  InputFile(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  /// Waits for the next bytes to fill `room`; gives how many, fewer only at the file's end. kDataLoss: unreadable.
  Result<std::size_t> Read(std::span<char> room);

  const std::string& name() const { return name_; }

 private:
  InputFile(int descriptor, std::string name);

  int descriptor_;
  std::string name_;
};

/// Every byte of a file, which may be a pipe. `kind` says what it should be: "a <kind> file".
/// kNotFound: there is no such file. kDataLoss: it is a directory, cannot be read or has more than `most_bytes`.
Result<std::string> ReadFile(const std::filesystem::path& path, std::string_view kind, std::uintmax_t most_bytes);

}  // namespace pendulum
