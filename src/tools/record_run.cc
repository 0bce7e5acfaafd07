// SPDX-License-Identifier: Apache-2.0
#include "tools/record_run.h"

#include <algorithm>
#include <variant>
#include <vector>

#include <poll.h>
#include <unistd.h>

#include "pendulum/acquisition/rest.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utc_time.h"
#include "tools/live_trace.h"
#include "tools/output.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

namespace wire = pendulum_logger;

constexpr double kPollSeconds = 0.05, kDrawSeconds = 0.1, kSynchroniseSeconds = 1, kReportSeconds = 10;
constexpr double kSilenceSeconds = 3, kSilenceFrames = 4;  // the longer one of the two times applies
constexpr double kStopSeconds = 5, kRepeatSeconds = 0.5;

/// Whether standard output is a pipe whose reader has closed it.
bool IsOutputClosed() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return ::poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

/// A timer that is due when `seconds` have passed since it was last due.
class PeriodicTimer {
 public:
  PeriodicTimer(double seconds, double now) : seconds_(seconds), last_(now) {}

  void Restart(double now) { last_ = now; }

  bool IsDue(double now) {
    if (now - last_ < seconds_) return false;
    last_ = now;
    return true;
  }

 private:
  double seconds_, last_;
};

/// One recording in progress.
class RunInProgress {
 public:
  RunInProgress(const RecordPendulumOptions& options, const std::atomic<bool>& stop, Logger& logger,
                RecordedRun& recorded)
      : options_(options),
        stop_(stop),
        logger_(logger),
        recorded_(recorded),
        part_(options.out),
        trace_(recorded.description.calibration ? "deg" : "counts"),
        lines_(STDERR_FILENO),
        is_live_(options.task == RecordTask::kRecord && CanRedraw(STDERR_FILENO)) {}

  Result<void> Record();

 private:
  Result<void> Begin();
  void Trim();
  void ReceiveUntilOver();
  void ProcessMessage(const TimedMessage& received);
  void ProcessData(const wire::Data& data, double host_time);
  void EndAsLost(const std::string& why);
  double LongestSilence() const;
  double Now() const { return logger_.port().Time(); }
  void StopWhenDue(double now);
  void WritePartFile(double now);
  void Show(double now);
  std::string LossText() const;

  const RecordPendulumOptions& options_;
  const std::atomic<bool>& stop_;
  Logger& logger_;
  RecordedRun& recorded_;
  PartFile part_;
  LiveTrace trace_;
  RedrawnLines lines_;
  bool is_live_;
  RestDetector rest_;
  std::size_t rest_samples_ = 0;  // number of samples until rest; 0: not at rest, or not requested
  PeriodicTimer draw_{kDrawSeconds, Now()}, report_{kReportSeconds, Now()}, synchronise_{kSynchroniseSeconds, Now()},
      repeat_{kRepeatSeconds, Now()};
  std::size_t written_ = 0;            // samples in the part file
  double silence_ = 0, stopping_ = 0;  // s: time without data; time since the stop was asked for
  double last_poll_ = 0;
  bool is_stopping_ = false, is_over_ = false;
};

Result<void> RunInProgress::Record() {
  RETURN_IF_ERROR(Begin());
  ReceiveUntilOver();
  Trim();
  recorded_.description.losses = recorded_.run.Losses();
  recorded_.damaged_frames = logger_.RejectedFrames();
  recorded_.description.clock = FitDeviceClock(recorded_.run.arrivals(), kUsbPolling, logger_.port().ClockStdDev());
  if (recorded_.run.size() > 0) return {};
  part_.Remove();
  if (recorded_.end == RunEnd::kStopped) {
    return Error(StatusCode::kTryAgain, "interrupted before anything was recorded");
  }
  return Error(StatusCode::kDataLoss, "nothing was recorded: " + recorded_.loss_reason);
}

/// Removes samples after the requested end.
void RunInProgress::Trim() {
  if (recorded_.end == RunEnd::kRest) {
    recorded_.run.KeepFirst(rest_samples_);
  } else if (options_.seconds) {
    recorded_.run.KeepUntil(*options_.seconds);
  }
}

/// Nothing is written before the logger has started.
Result<void> RunInProgress::Begin() {
  RETURN_IF_ERROR(logger_.Start());
  recorded_.description.begun = UtcTimeText();
  last_poll_ = Now();
  auto opened = part_.Open();
  if (opened) opened = part_.Append(RunHead(recorded_.description, options_.rate));
  if (!opened) recorded_.part_file_error = opened.error().message();
  return {};
}

void RunInProgress::ReceiveUntilOver() {
  while (!is_over_) {
    const auto received = logger_.Receive(kPollSeconds);
    const double now = Now();
    // The limit keeps the time in which this process was suspended from counting as silence of the logger.
    const double polled = std::min(now - last_poll_, 2 * kPollSeconds);
    silence_ += polled;
    stopping_ += is_stopping_ ? polled : 0;
    last_poll_ = now;
    if (!received) {
      EndAsLost(received.error().message());
    } else if (*received) {
      ProcessMessage(**received);
    }
    StopWhenDue(now);
    WritePartFile(now);
    Show(now);
  }
}

void RunInProgress::ProcessMessage(const TimedMessage& received) {
  if (const auto* data = std::get_if<wire::Data>(&received.message)) {
    ProcessData(*data, received.host_time);
  } else if (const auto* end = std::get_if<wire::End>(&received.message)) {
    recorded_.run.SetEnd(*end);
    if (!is_stopping_) EndAsLost("the logger ended the run on its own");
    is_over_ = true;
  } else if (std::holds_alternative<wire::Info>(received.message)) {
    EndAsLost("the logger restarted; check its power and reset line");
  }
}

void RunInProgress::ProcessData(const wire::Data& data, double host_time) {
  ReceivedRun& run = recorded_.run;
  const std::size_t first = run.size();
  if (!run.AddFrame(data, host_time)) return;
  silence_ = 0;
  const auto& calibration = recorded_.description.calibration;
  for (std::size_t i = first; i < run.size(); ++i) {
    const double counts = run.Counts(i);
    if (options_.until_rest && rest_samples_ == 0) {
      rest_.AddSample(run.Time(i), counts);
      if (rest_.IsAtRest()) rest_samples_ = i + 1;
    }
    trace_.Add(run.Time(i), calibration ? calibration->Angle(counts) / kRadFromDeg : counts, counts, kFullScaleCounts);
  }
}

void RunInProgress::EndAsLost(const std::string& why) {
  is_over_ = true;
  if (is_stopping_) return;  // the recording had already ended
  recorded_.end = RunEnd::kLost;
  recorded_.loss_reason = why;
}

double RunInProgress::LongestSilence() const {
  const auto step = static_cast<std::uint32_t>(options_.rate.Ticks());
  return std::max(kSilenceSeconds, kSilenceFrames * wire::BlockSize(step) / options_.rate.Hz());
}

void RunInProgress::StopWhenDue(double now) {
  if (is_over_) return;
  if (!is_stopping_) {
    const ReceivedRun& run = recorded_.run;
    const bool is_long_enough = options_.seconds && run.size() > 0 && run.Time(run.size() - 1) >= *options_.seconds;
    const bool is_at_rest = rest_samples_ > 0;
    if (silence_ > LongestSilence()) return EndAsLost("the logger stopped sending");
    if (IsStandardOutput(options_.out) && IsOutputClosed()) return EndAsLost("standard output was closed");
    if (!stop_ && !is_long_enough && !is_at_rest) return;
    recorded_.end = is_long_enough ? RunEnd::kSeconds : is_at_rest ? RunEnd::kRest : RunEnd::kStopped;
    is_stopping_ = true;
    repeat_.Restart(now);
  } else if (stopping_ > kStopSeconds) {
    is_over_ = true;  // the End frame is missing, which the description reports
    return;
  } else if (!repeat_.IsDue(now)) {
    return;
  }
  if (auto sent = logger_.RequestStop(); !sent) EndAsLost(sent.error().message());
}

/// Appends the new samples to the part file.
void RunInProgress::WritePartFile(double now) {
  if (!recorded_.part_file_error.empty() || !(is_over_ || synchronise_.IsDue(now))) return;
  std::string rows;
  for (; written_ < recorded_.run.size(); ++written_) rows += RunRow(recorded_.run, written_);
  auto kept = part_.Append(rows);
  if (kept) kept = part_.Synchronise();
  if (kept) return;
  recorded_.part_file_error = kept.error().message();
  if (!is_live_)
    PrintMessage(kRecordToolName, "warning: " + recorded_.part_file_error + "; the recording continues only in memory");
}

std::string RunInProgress::LossText() const {
  const RunLosses losses = recorded_.run.Losses();
  const std::string lost = losses.samples == 0 ? "none lost" : std::to_string(losses.samples) + " LOST";
  return recorded_.part_file_error.empty() ? lost : lost + ", NOT ON DISK";
}

void RunInProgress::Show(double now) {
  const ReceivedRun& run = recorded_.run;
  if (is_live_ && (is_over_ || draw_.IsDue(now))) {
    const TerminalSize size = SizeOfTerminal(STDERR_FILENO);
    std::vector<std::string> lines = trace_.Plot(size.columns);
    if (size.rows <= lines.size() + 1) lines.clear();
    lines.push_back(trace_.StatusLine(LossText()));
    lines_.Draw(lines, size.columns);
  } else if (!is_live_ && report_.IsDue(now) && run.size() > 0) {
    PrintMessage(kRecordToolName, NumberText(run.Time(run.size() - 1), 4) + " s, " + std::to_string(run.size()) +
                                      " samples, " + LossText());
  }
}

}  // namespace

std::string RecordedRun::Csv() const {
  std::string csv = RunHead(description, run.rate());
  for (std::size_t i = 0; i < run.size(); ++i) csv += RunRow(run, i);
  return csv;
}

Result<RecordedRun> RecordRun(const RecordPendulumOptions& options, const wire::Info& info,
                              const std::optional<Calibration>& calibration, const std::atomic<bool>& stop,
                              Logger& logger) {
  RecordedRun recorded(options.rate);
  recorded.description.logger = info;
  recorded.description.run = info.run + 1;
  recorded.description.calibration = calibration;
  RETURN_IF_ERROR(RunInProgress(options, stop, logger, recorded).Record());
  return recorded;
}

}  // namespace pendulum
