// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/live_recording.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "pendulum/base/file.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "service/live_points.h"
#include "service/live_run.h"
#include "service/run_tail.h"

namespace pendulum {
namespace {

constexpr std::size_t kMaxLiveBytes = std::size_t{64} << 20;  // an answer is held in memory
constexpr std::chrono::milliseconds kLivePollInterval{50};

std::string LiveStatusJson(const LiveStatus& status) {
  constexpr std::array<const char*, 3> kStates = {"waiting", "recording", "ended"};
  nlohmann::ordered_json json;
  json["state"] = kStates.at(static_cast<std::size_t>(status.state));
  json["name"] = status.name;
  json["samples"] = status.samples;
  json["unit"] = status.unit;
  json["rate_hz"] = status.rate ? nlohmann::ordered_json(*status.rate) : nlohmann::ordered_json(nullptr);
  return JsonText(json);
}

std::string LiveEvent(std::string_view name, const std::string& data) {
  return "event: " + std::string(name) + "\ndata: " + data + "\n\n";
}

std::string SamplesJson(const std::vector<LivePoint>& points) {
  constexpr int kDigits = 7;  // finer than the resolution of any sensor
  std::string times, values;
  for (const LivePoint& point : points) {
    (times += times.empty() ? "" : ",") += NumberText(point.time);
    (values += values.empty() ? "" : ",") += NumberText(point.value, kDigits);
  }
  return "{\"time_s\":[" + times + "],\"values\":[" + values + "]}";
}

/// The bytes of an open, possibly growing, file up to its last line end. `name`: for messages.
Result<std::string> WholeLinesOf(int descriptor, const std::string& name) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  struct stat status {};
  const bool is_known = ::fstat(descriptor, &status) == 0;
  std::size_t room = (is_known ? static_cast<std::size_t>(status.st_size) : 0) + 1, size = 0;
  std::string bytes;
  while (room <= kMaxLiveBytes + 1) {
    bytes.resize(room);
    const ssize_t added = ::read(descriptor, bytes.data() + size, room - size);
    if (added <= 0) {
      bytes.resize(size);
      bytes.resize(bytes.rfind('\n') + 1);  // npos + 1 is 0
      return bytes;
    }
    size += static_cast<std::size_t>(added);
    if (size == room) room += kBlock;
  }
  return Fault(name, "it is larger than 64 MiB; fit this file with fit_pendulum");
}

Result<std::string> WholeLinesOf(const std::filesystem::path& run) {
  const std::string name = run.filename().string();
  int descriptor = OpenRegularFile(run.string() + ".part");
  if (descriptor < 0) descriptor = OpenRegularFile(run);
  if (descriptor < 0) {
    return ErrorAt(StatusCode::kNotFound, name, "there is no recording yet; start record_pendulum --out " + name);
  }
  auto bytes = WholeLinesOf(descriptor, name);
  ::close(descriptor);
  return bytes;
}

/// The data that one listener has received.
struct LiveCursor {
  std::string status;        // The last status sent.
  bool has_samples = false;  // The run so far was sent.
  std::uint64_t run = 0;     // Number of the run.
  std::uint64_t next = 0;    // Number of the next point to send.
  double time = 0;           // s, of the last point sent.
};

}  // namespace

class LiveRecording::Reader {
 public:
  explicit Reader(const std::filesystem::path& run) : run_path_(run), name_(run.filename().string()), tail_(run) {}

  void Poll() {
    const std::scoped_lock lock(mutex_);
    PollLocked();
  }

  LiveStatus Status() const {
    const std::scoped_lock lock(mutex_);
    return StatusLocked();
  }

  EventText Next(LiveCursor& cursor) {
    const std::scoped_lock lock(mutex_);
    if (std::chrono::steady_clock::now() - polled_ >= kLivePollInterval) PollLocked();
    EventText events;
    if (cursor.has_samples && (cursor.run != number_ || cursor.next < run_.latest_begin)) {
      cursor = LiveCursor();
      AppendStatus(LiveStatus{LiveState::kWaiting, name_, 0, "", {}}, cursor, events.text);
    }
    AppendStatus(StatusLocked(), cursor, events.text);
    if (!has_more_ && run_.samples > 0) AppendSamples(cursor, events.text);
    return events;
  }

  const std::filesystem::path& run_path() const { return run_path_; }

 private:
  void PollLocked() {
    const RunTail::News news = tail_.Look();
    if (news.is_another) {
      run_ = LiveRun();
      ++number_;
    }
    run_.Read(news.lines);
    has_more_ = news.has_more;
    if (!tail_.is_growing() && !has_more_) run_.FlushPoints();
    polled_ = std::chrono::steady_clock::now();
  }

  LiveStatus StatusLocked() const {
    LiveStatus status;
    status.name = name_;
    if (!run_.rows.has_begun()) return status;
    status.state = tail_.is_growing() ? LiveState::kRecording : LiveState::kEnded;
    status.samples = run_.samples;
    status.unit = run_.rows.unit();
    status.rate = run_.rows.rate();
    return status;
  }

  static void AppendStatus(const LiveStatus& status, LiveCursor& cursor, std::string& text) {
    std::string json = LiveStatusJson(status);
    if (json == cursor.status) return;
    text += LiveEvent("state", json);
    cursor.status = std::move(json);
  }

  void AppendSamples(LiveCursor& cursor, std::string& text) const {
    std::vector<LivePoint> points;
    if (!cursor.has_samples) {
      points = run_.whole.Points();
    } else {
      for (auto number = cursor.next; number < run_.latest_end(); ++number) {
        const LivePoint& point = run_.latest[number - run_.latest_begin];
        if (point.time > cursor.time) points.push_back(point);
      }
    }
    cursor.has_samples = true;
    cursor.run = number_;
    cursor.next = run_.latest_end();
    if (points.empty()) return;
    cursor.time = points.back().time;
    text += LiveEvent("samples", SamplesJson(points));
  }

  const std::filesystem::path run_path_;
  const std::string name_;
  mutable std::mutex mutex_;  // for all members below
  RunTail tail_;
  LiveRun run_;
  std::uint64_t number_ = 0;  // number of the run
  bool has_more_ = false;     // more data is available; samples are sent after it is read
  std::chrono::steady_clock::time_point polled_;
};

LiveRecording::LiveRecording(const std::filesystem::path& run) : reader_(std::make_shared<Reader>(run)) {}

void LiveRecording::Poll() { reader_->Poll(); }

LiveStatus LiveRecording::Status() const { return reader_->Status(); }

std::string LiveRecording::StatusJson() const { return LiveStatusJson(Status()); }

NextEvents LiveRecording::Listen() {
  return [reader = reader_, cursor = LiveCursor()]() mutable { return reader->Next(cursor); };
}

Result<std::string> LiveRecording::Bytes() const { return WholeLinesOf(reader_->run_path()); }

}  // namespace pendulum
