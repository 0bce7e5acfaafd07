// SPDX-License-Identifier: Apache-2.0
#include "service/run_tail.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace pendulum {
namespace {

constexpr std::size_t kRunTailLook = std::size_t{4} << 20;         // bytes
constexpr std::size_t kRunTailBlock = std::size_t{1} << 16;        // bytes
constexpr std::size_t kRunTailHead = 512;                          // bytes
constexpr std::size_t kRunTailLongestLine = std::size_t{1} << 17;  // bytes; a calibration has at most 64 KiB
constexpr double kRunTailSilence = 60;                             // s; record_pendulum writes once a second

/// Reads bytes of a file from an offset; fewer than `room` at its end or after an error.
std::string_view ReadAt(int descriptor, std::uintmax_t offset, std::span<char> room) {
  const ssize_t size = ::pread(descriptor, room.data(), room.size(), static_cast<off_t>(offset));
  return {room.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
}

}  // namespace

int OpenRegularFile(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  struct stat status {};
  if (descriptor < 0 || (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))) return descriptor;
  ::close(descriptor);
  return -1;
}

RunTail::RunTail(const std::filesystem::path& run) : run_(run), part_(run.string() + ".part") {}

RunTail::~RunTail() { Forget(); }

std::optional<RunTail::FileIdentity> RunTail::IdentityOf(const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  return FileIdentity{status.st_dev, status.st_ino, static_cast<std::uintmax_t>(status.st_size),
                      now.count() - static_cast<double>(status.st_mtim.tv_sec)};
}

std::optional<RunTail::FileIdentity> RunTail::Find(const std::filesystem::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? IdentityOf(status) : std::nullopt;
}

/// Closes the followed file; returns whether there was one.
bool RunTail::Forget() {
  offset_ = 0;
  head_.clear();
  unfinished_.clear();
  is_line_too_long_ = false;
  return descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) == 0;
}

/// Whether the file continues the data read so far. A new run in the same file is shorter or has another beginning.
bool RunTail::IsSameFile(const FileIdentity& file) const {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) return false;
  if (status.st_dev != file.device || status.st_ino != file.node || file.size < offset_) return false;
  std::array<char, kRunTailHead> room;
  return ReadAt(descriptor_, 0, room).starts_with(head_);
}

RunTail::News RunTail::Look() {
  News news;
  const auto part = Find(part_), run = Find(run_);
  const auto& current = part ? part : run;
  is_growing_ = part && part->age < kRunTailSilence;
  if (!current || !IsSameFile(*current)) {
    news.is_another = Forget();
    if (current) descriptor_ = OpenRegularFile(part ? part_ : run_);
  }
  if (descriptor_ >= 0) ReadOn(news);
  return news;
}

void RunTail::ReadOn(News& news) {
  std::array<char, kRunTailBlock> room;
  for (std::size_t taken = 0; taken < kRunTailLook;) {
    const std::string_view bytes = ReadAt(descriptor_, offset_, room);
    if (bytes.empty()) return;
    if (head_.size() < kRunTailHead) head_ += bytes.substr(0, kRunTailHead - head_.size());
    AppendCompleteLines(bytes, news.lines);
    offset_ += bytes.size();
    taken += bytes.size();
  }
  news.has_more = true;
}

void RunTail::AppendCompleteLines(std::string_view bytes, std::string& lines) {
  const std::size_t end = bytes.rfind('\n');
  const bool is_too_long = unfinished_.size() + bytes.size() > kRunTailLongestLine;
  if (end == std::string_view::npos) {
    is_line_too_long_ = is_line_too_long_ || is_too_long;
    if (is_line_too_long_) {
      unfinished_.clear();
    } else {
      unfinished_ += bytes;
    }
    return;
  }
  if (is_line_too_long_) {
    const std::size_t next = bytes.find('\n') + 1;
    lines += bytes.substr(next, end + 1 - next);
  } else {
    (lines += unfinished_) += bytes.substr(0, end + 1);
  }
  is_line_too_long_ = false;
  unfinished_ = bytes.substr(end + 1);
}

}  // namespace pendulum
