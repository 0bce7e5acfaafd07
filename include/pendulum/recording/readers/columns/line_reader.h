// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "pendulum/base/file.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/status.h"

namespace pendulum {

/// Reads the lines of a text and computes the SHA-256 of its bytes. At most one block of a file is in memory at a time.
/// A byte order mark before the first line is skipped. kDataLoss for data that cannot be CSV text: a NUL byte
/// (path:line:column), or a line longer than kLongestLine.
class LineReader {
 public:
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;  ///< Bytes.

  /// The lines of a text in memory, which must outlive this object. `name` replaces the path in messages.
  LineReader(std::string_view text, std::string name);

  /// The lines of a file from its current position. `begin` holds the bytes already read from it, fewer than
  /// kLongestLine.
  explicit LineReader(InputFile file, std::string_view begin = {});

  LineReader(LineReader&& other) noexcept;
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;
  LineReader& operator=(LineReader&&) = delete;
  ~LineReader();

  /// Advances to the next line; false if there is none. kDataLoss: as above, or the file cannot be read.
  Result<bool> Next() {
    if (TakeBufferedLine()) return true;
    return NextBlock();
  }

  /// The bytes after the current line, at most about `max_bytes`, without advancing. The last line may be incomplete. A
  /// pipe is read up to there and the bytes are kept. kDataLoss: as Next.
  Result<std::string> Peek(std::size_t max_bytes);

  std::string_view line() const { return line_; }        ///< The line without its end (LF or CRLF), valid until Next.
  std::size_t number() const { return number_; }         ///< 1-based number of the line; 0 before the first line.
  bool is_terminated() const { return is_terminated_; }  ///< False for a last line without a line end.
  bool is_empty() const { return is_empty_; }
  const std::string& name() const { return name_; }

  /// SHA-256 of all bytes, lower-case hexadecimal; call after Next has returned false. kInternal: OpenSSL cannot
  /// compute it.
  Result<std::string> Sha256() { return digest_.Text(); }

 private:
  /// Room for the longest permitted line with its end. A longer line fills the block.
  using Block = std::array<char, kLongestLine + 2>;

  bool TakeBufferedLine();
  Result<bool> NextBlock();
  void TakeLine(const char* line_end);
  Result<void> Begin();
  Result<void> Refill();
  Result<std::size_t> Read(std::span<char> room);
  Result<void> HashAndCheck(std::string_view bytes);
  tl::unexpected<Status> TooLongError() const;

  std::string name_;
  std::unique_ptr<InputFile> file_;  // Null once all bytes are in memory.
  std::string ahead_;                // Bytes that Peek read from the file beyond the block.
  std::size_t ahead_at_ = 0;         // The first of them that is not yet in the block.
  std::unique_ptr<Block> block_;     // Null if all bytes were in memory from the start.
  const char* at_ = nullptr;         // First byte in memory after the current line.
  const char* end_ = nullptr;        // End of the bytes in memory.
  Sha256Digest digest_;
  std::string_view line_;
  std::size_t number_ = 0;
  bool is_terminated_ = true;
  bool is_empty_ = true;
  bool has_begun_ = false;
};

}  // namespace pendulum
