// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/columns/line_reader.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utf8.h"

namespace pendulum {
namespace {

/// The first byte equal to `wanted`, or nullptr.
const char* Find(const char* from, const char* end, char wanted) {
  return from == end ? nullptr : static_cast<const char*>(std::memchr(from, wanted, end - from));
}

}  // namespace

LineReader::LineReader(std::string_view text, std::string name)
    : name_(std::move(name)), at_(text.data()), end_(text.data() + text.size()) {}

LineReader::LineReader(InputFile file, std::string_view begin)
    : name_(file.name()),
      file_(std::make_unique<InputFile>(std::move(file))),
      block_(std::make_unique_for_overwrite<Block>()),
      at_(block_->data()),
      end_(std::copy_n(begin.data(), std::min(begin.size(), kLongestLine), block_->data())) {}

LineReader::LineReader(LineReader&& other) noexcept = default;
LineReader::~LineReader() = default;

Result<void> LineReader::Begin() {
  has_begun_ = true;
  RETURN_IF_ERROR(HashAndCheck({at_, end_}));
  if (file_ != nullptr) {
    RETURN_IF_ERROR(Refill());
  }
  is_empty_ = at_ == end_;
  at_ = WithoutByteOrderMark({at_, end_}).data();
  return {};
}

/// Fills `room` with the bytes that were read ahead, then from the file.
Result<std::size_t> LineReader::Read(std::span<char> room) {
  const std::size_t kept = std::min(room.size(), ahead_.size() - ahead_at_);
  std::copy_n(ahead_.data() + ahead_at_, kept, room.data());
  ahead_at_ += kept;
  if (ahead_at_ == ahead_.size()) {
    ahead_ = {};
    ahead_at_ = 0;
  }
  if (kept == room.size()) return kept;
  const Result<std::size_t> got = file_->Read(room.subspan(kept));
  return got ? kept + *got : got;
}

Result<std::string> LineReader::Peek(std::size_t max_bytes) {
  if (!has_begun_) {
    RETURN_IF_ERROR(Begin());
  }
  std::string bytes(at_, std::min<std::size_t>(end_ - at_, max_bytes));
  if (file_ == nullptr || bytes.size() == max_bytes) return bytes;
  const std::size_t wanted = max_bytes - bytes.size();
  const std::size_t kept = ahead_.size() - ahead_at_;
  if (kept < wanted) {
    ahead_.erase(0, std::exchange(ahead_at_, 0));
    ahead_.resize(wanted);
    ASSIGN_OR_RETURN(const std::size_t got, file_->Read(std::span(ahead_).subspan(kept)));
    ahead_.resize(kept + got);
  }
  return bytes + ahead_.substr(ahead_at_, wanted);
}

/// Moves the remaining bytes of the block to its front and reads more data after them.
Result<void> LineReader::Refill() {
  const std::size_t left = end_ - at_;
  std::memmove(block_->data(), at_, left);
  ASSIGN_OR_RETURN(const std::size_t got, Read({block_->data() + left, block_->size() - left}));
  at_ = block_->data();
  end_ = at_ + left + got;
  if (left + got < block_->size()) file_.reset();
  return HashAndCheck({at_ + left, got});
}

/// Hashes new bytes and checks for NUL bytes, which come from a logger that lost its power or from an encoding with two
/// bytes per character.
Result<void> LineReader::HashAndCheck(std::string_view bytes) {
  RETURN_IF_ERROR(digest_.Add(bytes));
  const char* nul = Find(bytes.data(), bytes.data() + bytes.size(), '\0');
  if (nul == nullptr) return {};
  const std::string_view before(at_, nul);
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0: the line that starts at at_.
  return Fault(name_ + ":" + std::to_string(number_ + 1 + std::ranges::count(before, '\n')) + ":" +
                   std::to_string(before.size() - line_begin + 1),
               "there is a NUL byte, so this is not CSV text; delete the damaged part, or save UTF-16 as UTF-8");
}

tl::unexpected<Status> LineReader::TooLongError() const {
  return Fault(name_ + ":" + std::to_string(number_ + 1) + ":1", "this line is longer than 1 MiB and begins with " +
                                                                     Quoted({at_, end_}) +
                                                                     ", so this is not CSV text; name a CSV file");
}

/// Takes the next line if it is completely in memory.
bool LineReader::TakeBufferedLine() {
  const char* line_end = Find(at_, end_, '\n');
  if (line_end == nullptr || !has_begun_ || static_cast<std::size_t>(line_end - at_) > kLongestLine) return false;
  is_terminated_ = true;
  TakeLine(line_end);
  at_ = line_end + 1;
  return true;
}

void LineReader::TakeLine(const char* line_end) {
  line_ = {at_, line_end};
  while (line_.ends_with('\r')) line_.remove_suffix(1);
  ++number_;
}

/// Takes the next line when more data must be read, or the last line, or returns an error.
Result<bool> LineReader::NextBlock() {
  if (!has_begun_) {
    RETURN_IF_ERROR(Begin());
  }
  while (!TakeBufferedLine()) {
    if (static_cast<std::size_t>(end_ - at_) > kLongestLine) return TooLongError();
    if (file_ == nullptr) {
      if (at_ == end_) return false;
      is_terminated_ = false;
      TakeLine(end_);
      at_ = end_;
      return true;
    }
    RETURN_IF_ERROR(Refill());
  }
  return true;
}

}  // namespace pendulum
