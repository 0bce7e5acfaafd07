// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/live_recording.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace pendulum::live_recording_test {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

// The header that record_pendulum writes for a simulated logger.
constexpr const char* kHead =
    "# pendulum_logger version 1.0, Arduino Uno, reference: supply voltage (AVcc)\n"
    "# run 1 of this logger, begun 2026-05-06T07:08:09Z\n# sample_rate_hz: 200\n# resolution: 1\n# range: 0,1023\n"
    "# the clock was not measured: its error is that of a ceramic resonator\n# clock_scale: 1\n"
    "# clock_scale_std_dev: 0.003\n# part of a run: the number of lost samples is not known\n";

const std::string kCounts = std::string(kHead) + "time_s,adc_counts\n";

/// One event of a stream: its name and its data.
using Event = std::pair<std::string, Json>;

std::vector<Event> EventsOf(std::string text) {
  std::vector<Event> events;
  while (!text.empty()) {
    const std::size_t data = text.find("\ndata: "), end = text.find("\n\n");
    if (!text.starts_with("event: ") || data == std::string::npos || end == std::string::npos) {
      ADD_FAILURE() << "no event: " << text.substr(0, 200);
      return events;
    }
    events.emplace_back(text.substr(7, data - 7), Json::parse(text.substr(data + 7, end - data - 7)));
    text.erase(0, end + 2);
  }
  return events;
}

class LiveRecordingTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void Append(const std::string& text) const { std::ofstream(part_, std::ios::binary | std::ios::app) << text; }
  void Begin(const std::string& text) const { std::ofstream(part_, std::ios::binary | std::ios::trunc) << text; }

  /// Ends a run like record_pendulum: the complete recording gets its name, then the part file is removed.
  void End(const std::string& text) const {
    std::ofstream(folder_ / "whole", std::ios::binary) << text;
    fs::rename(folder_ / "whole", run_);
    fs::remove(part_);
  }

  /// Reads the available data and returns "state samples unit rate".
  std::string Look() {
    live_.Poll();
    const Json json = Json::parse(live_.StatusJson());
    EXPECT_EQ(json["name"], "run.csv");
    return json["state"].get<std::string>() + " " + json["samples"].dump() + " " + json["unit"].get<std::string>() +
           " " + json["rate_hz"].dump();
  }

  /// The events for a listener after all data has been read.
  std::vector<Event> Hear(const NextEvents& next) {
    live_.Poll();
    const EventText events = next();
    EXPECT_FALSE(events.is_last);
    return EventsOf(events.text);
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("live_recording_test_" + std::to_string(getpid()));
  const fs::path run_ = folder_ / "run.csv", part_ = folder_ / "run.csv.part";
  LiveRecording live_{run_};
};

/// The names of events; for a state event the state.
std::vector<std::string> NamesOf(const std::vector<Event>& events) {
  std::vector<std::string> names;
  for (const auto& [name, data] : events) names.push_back(name == "state" ? data["state"].get<std::string>() : name);
  return names;
}

std::vector<double> NumbersOf(const std::vector<Event>& events, const std::string& key) {
  std::vector<double> numbers;
  for (const auto& [name, data] : events) {
    if (name == "samples") numbers.insert(numbers.end(), data[key].begin(), data[key].end());
  }
  return numbers;
}

/// Rows of a decaying swing in counts, at a sampling rate.
std::string Rows(int first, int end, double rate = 200) {
  std::string rows;
  for (int i = first; i < end; ++i) {
    const double time = i / rate;
    rows += Json(time).dump() + "," +
            std::to_string(std::lround(512 + 300 * std::exp(-time / 50) * std::sin(6 * time))) + "\n";
  }
  return rows;
}

// ---- States --------------------------------------------------------------------------------------------------------

TEST_F(LiveRecordingTest, WaitsIfThereIsNoFile) {
  EXPECT_EQ(Look(), "waiting 0  null");
  const auto bytes = live_.Bytes();
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, StatusCode::kNotFound);
  EXPECT_EQ(bytes.error().message(), "run.csv: there is no recording yet; start record_pendulum --out run.csv");
}

TEST_F(LiveRecordingTest, FollowsARunFromStartToEnd) {
  Begin("");
  EXPECT_EQ(Look(), "waiting 0  null");
  Append(kHead);
  EXPECT_EQ(Look(), "waiting 0  null");  // no column names yet
  Append("time_s,adc_counts\n");
  EXPECT_EQ(Look(), "recording 0 counts 200.0");
  Append("0,500\n0.005,501\n");
  EXPECT_EQ(Look(), "recording 2 counts 200.0");
  Append("0.01,502\n");
  End(kCounts + "0,500\n0.005,501\n0.01,502\n");
  EXPECT_EQ(Look(), "ended 3 counts 200.0");
  EXPECT_EQ(Look(), "ended 3 counts 200.0");
}

TEST_F(LiveRecordingTest, ReadsARunThatHasAlreadyEnded) {
  End(kCounts + Rows(0, 7));
  EXPECT_EQ(Look(), "ended 7 counts 200.0");
}

TEST_F(LiveRecordingTest, PrefersThePartFileToAnEarlierRun) {
  End(kCounts + Rows(0, 7));
  Begin(kCounts + Rows(0, 3));
  EXPECT_EQ(Look(), "recording 3 counts 200.0");
  fs::remove(part_);
  fs::remove(run_);
  EXPECT_EQ(Look(), "waiting 0  null");
}

TEST_F(LiveRecordingTest, UsesCompleteLinesOnly) {
  Begin(kCounts + "0,50");
  EXPECT_EQ(Look(), "recording 0 counts 200.0");
  Append("0\n0.0");
  EXPECT_EQ(Look(), "recording 1 counts 200.0");
  EXPECT_EQ(*live_.Bytes(), kCounts + "0,500\n");
  Append("05,501\r\n");
  EXPECT_EQ(Look(), "recording 2 counts 200.0");
  EXPECT_EQ(*live_.Bytes(), kCounts + "0,500\n0.005,501\r\n");
}

// The part file may have rows after the requested duration; the complete recording has none.
TEST_F(LiveRecordingTest, ReadsTheCompleteRecordingWhenAvailable) {
  Begin(kCounts + Rows(0, 1218));
  const NextEvents next = live_.Listen();
  EXPECT_THAT(NamesOf(Hear(next)), ElementsAre("recording", "samples"));
  End(kCounts + Rows(0, 1200));
  EXPECT_EQ(Look(), "ended 1200 counts 200.0");
  const auto events = Hear(next);
  EXPECT_THAT(NamesOf(events), ElementsAre("waiting", "ended", "samples"));
  EXPECT_EQ(NumbersOf(events, "time_s").size(), 1200);
  EXPECT_EQ(*live_.Bytes(), kCounts + Rows(0, 1200));
}

TEST_F(LiveRecordingTest, ForgetsAnAbandonedRun) {
  Begin(kCounts + Rows(0, 10));
  EXPECT_EQ(Look(), "recording 10 counts 200.0");
  fs::remove(part_);
  EXPECT_EQ(Look(), "waiting 0  null");
}

TEST_F(LiveRecordingTest, RestartsWithAnotherRun) {
  Begin(kCounts + Rows(0, 10));
  EXPECT_EQ(Look(), "recording 10 counts 200.0");
  Begin(kCounts + Rows(0, 4));  // the same file, shorter
  EXPECT_EQ(Look(), "recording 4 counts 200.0");
  std::string later = kCounts + Rows(0, 30);
  later.replace(later.find("run 1 "), 6, "run 2 ");
  Begin(later);  // the same file, longer, with another head
  EXPECT_EQ(Look(), "recording 30 counts 200.0");
  std::ofstream(folder_ / "other") << "time_s,angle_deg\n0,1\n";
  fs::rename(folder_ / "other", part_);  // another file
  EXPECT_EQ(Look(), "recording 1 deg null");
  End(kCounts + Rows(0, 1));
  EXPECT_EQ(Look(), "ended 1 counts 200.0");
  Begin(kCounts + Rows(0, 2));  // the next run
  EXPECT_EQ(Look(), "recording 2 counts 200.0");
  End(kCounts + Rows(0, 2));
  EXPECT_EQ(Look(), "ended 2 counts 200.0");
  End(kCounts + Rows(0, 5));  // its part file was never seen
  EXPECT_EQ(Look(), "ended 5 counts 200.0");
}

TEST_F(LiveRecordingTest, EndsIfNobodyWritesToThePartFile) {
  Begin(kCounts + Rows(0, 3));
  fs::last_write_time(part_, fs::file_time_type::clock::now() - std::chrono::minutes(5));
  EXPECT_EQ(Look(), "ended 3 counts 200.0");
  Append(Rows(3, 4));
  EXPECT_EQ(Look(), "recording 4 counts 200.0");
}

TEST_F(LiveRecordingTest, ReadsAnyBytes) {
  std::string noise;
  std::uint32_t state = 1;
  for (int i = 0; i < 1'000'000; ++i) {
    state = state * 1664525 + 1013904223;  // random numbers: Numerical Recipes, section 7.1
    noise += static_cast<char>(state >> 24);
  }
  Begin(noise);
  live_.Poll();
  Append(kCounts);
  EXPECT_THAT(Look(), StartsWith("recording "));
  EXPECT_NE(live_.Listen()().text, "");
}

// ---- Events --------------------------------------------------------------------------------------------------------

TEST_F(LiveRecordingTest, SendsStateAndSamplesToEachListener) {
  const NextEvents early = live_.Listen();
  auto events = Hear(early);
  ASSERT_THAT(NamesOf(events), ElementsAre("waiting"));
  EXPECT_EQ(events[0].second.dump(), R"({"state":"waiting","name":"run.csv","samples":0,"unit":"","rate_hz":null})");
  EXPECT_THAT(Hear(early), IsEmpty());
  Begin(kCounts);
  EXPECT_THAT(NamesOf(Hear(early)), ElementsAre("recording"));
  Append("0,500\n0.1,501\n");
  events = Hear(early);
  ASSERT_THAT(NamesOf(events), ElementsAre("recording", "samples"));
  EXPECT_EQ(events[0].second.dump(),
            R"({"state":"recording","name":"run.csv","samples":2,"unit":"counts","rate_hz":200.0})");
  EXPECT_EQ(events[1].second.dump(), R"({"time_s":[0,0.1],"values":[500,501]})");
  EXPECT_THAT(Hear(early), IsEmpty());
  const NextEvents late = live_.Listen();
  Append("0.2,502\n");
  EXPECT_EQ(NumbersOf(Hear(early), "time_s"), std::vector<double>({0.2}));
  EXPECT_EQ(NumbersOf(Hear(late), "time_s"), std::vector<double>({0, 0.1, 0.2}));
  End(kCounts + "0,500\n");
  EXPECT_THAT(NamesOf(Hear(early)), ElementsAre("waiting", "ended", "samples"));
  EXPECT_EQ(NumbersOf(Hear(late), "values"), std::vector<double>({500}));
  EXPECT_THAT(Hear(late), IsEmpty());
}

TEST_F(LiveRecordingTest, ReportsWaitingBeforeSamplesOfAnotherRun) {
  Begin(kCounts + Rows(0, 10));
  const NextEvents next = live_.Listen();
  EXPECT_THAT(NamesOf(Hear(next)), ElementsAre("recording", "samples"));
  Begin(kCounts + "0,1\n");
  const auto events = Hear(next);
  EXPECT_THAT(NamesOf(events), ElementsAre("waiting", "recording", "samples"));
  EXPECT_THAT(NumbersOf(events, "values"), ElementsAre(1));
  fs::remove(part_);
  EXPECT_THAT(NamesOf(Hear(next)), ElementsAre("waiting"));
}

TEST_F(LiveRecordingTest, MayBeDestroyedBeforeOrAfterItsListeners) {
  Begin(kCounts + "0,1\n");
  NextEvents next;
  {
    LiveRecording live(run_);
    next = live.Listen();
    live.Listen();
  }
  EXPECT_THAT(NamesOf(EventsOf(next().text)), ElementsAre("recording", "samples"));
}

TEST_F(LiveRecordingTest, SendsEverySampleOfASlowRun) {
  Begin(kCounts);
  const NextEvents next = live_.Listen();
  std::vector<double> times;
  for (int second = 0; second < 20; ++second) {
    Append(Rows(40 * second, 40 * second + 40, 40));
    const auto heard = NumbersOf(Hear(next), "time_s");
    times.insert(times.end(), heard.begin(), heard.end());
  }
  ASSERT_EQ(times.size(), 800);
  for (int i = 0; i < 800; ++i) EXPECT_EQ(times[static_cast<std::size_t>(i)], i / 40.0);
}

TEST_F(LiveRecordingTest, SendsAtMostFiftyPointsPerSecondWithExtremes) {
  constexpr int kSeconds = 30, kRate = 1000;
  Begin(kCounts);
  const NextEvents next = live_.Listen();
  Hear(next);
  std::vector<double> times, values;
  const auto hear = [&] {
    const auto events = Hear(next);
    const auto heard = NumbersOf(events, "time_s"), readings = NumbersOf(events, "values");
    times.insert(times.end(), heard.begin(), heard.end());
    values.insert(values.end(), readings.begin(), readings.end());
  };
  for (int step = 0; step < 10 * kSeconds; ++step) {
    const int first = step * kRate / 10;
    std::string rows = Rows(first, first + kRate / 10, kRate);
    if (step == 123) rows.replace(rows.rfind(',') + 1, std::string::npos, "1023\n");  // one extreme sample
    Append(rows);
    hear();
  }
  EXPECT_TRUE(std::ranges::adjacent_find(times, std::ranges::greater_equal()) == times.end());
  EXPECT_EQ(std::ranges::max(values), 1023);
  EXPECT_GT(times.back(), kSeconds - 0.1);
  // Starts at 0.1 s: the first event sends all rows written before it, not thinned.
  for (double second = 0.1; second + 1 <= kSeconds; second += 0.13) {
    const auto count = std::ranges::count_if(times, [&](double t) { return t >= second && t < second + 1; });
    EXPECT_LE(count, 52) << second;  // two more if a block begins before the second
    EXPECT_GE(count, 40) << second;
  }
}

TEST_F(LiveRecordingTest, RestartsForAListenerThatIsMinutesBehind) {
  Begin(kCounts + Rows(0, 10));
  const NextEvents prompt = live_.Listen(), late = live_.Listen();
  Hear(prompt);
  Hear(late);
  for (int minute = 0; minute < 3; ++minute) {
    Append(Rows(std::max(10, 12'000 * minute), 12'000 * (minute + 1)));
    EXPECT_THAT(NamesOf(Hear(prompt)), ElementsAre("recording", "samples"));
  }
  const auto events = Hear(late);
  EXPECT_THAT(NamesOf(events), ElementsAre("waiting", "recording", "samples"));
  const auto times = NumbersOf(events, "time_s");
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 35'999 / 200.0);
}

// ---- Long runs -----------------------------------------------------------------------------------------------------

TEST_F(LiveRecordingTest, ThinsALongRunButKeepsEndsAndExtremes) {
  for (const int samples : {1, 2, 1900, 3997, 3999, 4001, 20'000, 100'000}) {
    std::string rows = Rows(0, samples);
    if (samples > 3) rows.replace(rows.find(',', rows.size() / 3) + 1, 3, "-77");
    Begin(kCounts + rows);
    EXPECT_EQ(Look(), "recording " + std::to_string(samples) + " counts 200.0");
    const auto events = Hear(live_.Listen());
    const auto times = NumbersOf(events, "time_s"), values = NumbersOf(events, "values");
    EXPECT_EQ(values.size(), times.size());
    EXPECT_LE(times.size(), 4000);
    EXPECT_GE(times.size(), std::min(samples, 1900));
    EXPECT_TRUE(std::ranges::adjacent_find(times, std::ranges::greater_equal()) == times.end());
    EXPECT_EQ(times.front(), 0);
    EXPECT_EQ(times.back(), (samples - 1) / 200.0);
    if (samples > 3) {
      EXPECT_EQ(std::ranges::min(values), -77);
    }
    fs::remove(part_);
  }
}

TEST_F(LiveRecordingTest, LimitsTheSizeOfTheFile) {
  Begin(kCounts);
  fs::resize_file(part_, (std::uintmax_t{1} << 29) + 1);  // a sparse file: it uses no disk space
  const auto bytes = live_.Bytes();
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().code, StatusCode::kDataLoss);
  EXPECT_EQ(bytes.error().message(), "run.csv: it is larger than 64 MiB; fit this file with fit_pendulum");
}

TEST_F(LiveRecordingTest, IsThreadSafe) {
  Begin(kCounts);
  std::vector<std::thread> threads;
  std::vector<std::string> heard(4);
  for (std::string& text : heard) {
    threads.emplace_back([this, &text] {
      const NextEvents next = live_.Listen();
      for (int i = 0; i < 200; ++i) {
        live_.Poll();
        text += next().text;
        text += live_.StatusJson().starts_with("{") && live_.Bytes() ? "" : "broken";
      }
    });
  }
  for (int i = 0; i < 200; ++i) Append(Rows(i, i + 1));
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(Look(), "recording 200 counts 200.0");
  for (const std::string& text : heard) EXPECT_THAT(NamesOf(EventsOf(text)), Each(testing::Ne("waiting")));
}

}  // namespace
}  // namespace pendulum::live_recording_test
