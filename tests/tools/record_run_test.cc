// SPDX-License-Identifier: Apache-2.0
#include "tools/record_run.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/recording/readers/read_recording.h"
#include "tests/acquisition/scripted_logger.h"
#include "tests/tools/temporary_folder.h"
#include "tools/record_text.h"

namespace pendulum::record_run_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::StartsWith;

using Then = LoggerScript::Then;

/// A scripted logger at 200 Hz, and a recording of it in run.csv of a separate folder.
struct Laboratory {
  explicit Laboratory(LoggerScript script = {}) : board(std::move(script)), logger(board, stop) {
    options.out = folder.Path("run.csv");
  }

  Result<RecordedRun> Record() { return RecordRun(options, LoggerScript().info, calibration, stop, logger); }

  /// A recording that must succeed.
  RecordedRun Recorded() {
    auto recorded = Record();
    EXPECT_TRUE(recorded) << recorded.error().message();
    return recorded ? *std::move(recorded) : RecordedRun(options.rate);
  }

  TemporaryFolder folder;
  ScriptedLogger board;
  std::atomic<bool> stop = false;
  Logger logger;
  RecordPendulumOptions options;
  std::optional<Calibration> calibration;
};

/// Each sample is 100 counts above the previous one, modulo 1000, so missing or repeated samples are detected.
int Sawtooth(double time) { return 20 + static_cast<int>(std::lround(200 * time) * 100 % 1000); }

LoggerScript WithSawtooth() {
  LoggerScript script;
  script.counts = Sawtooth;
  return script;
}

/// The recording parsed from the file's text.
Recording ReadBack(const std::string& text) {
  const auto recording = ParseRecording(text, "run.csv");
  EXPECT_TRUE(recording) << recording.error().message();
  return recording.value_or(Recording());
}

/// Checks that the recording is exactly the first `count` samples of the sawtooth.
void ExpectSawtooth(const Recording& recording, int count) {
  ASSERT_EQ(recording.size(), count);
  for (int i = 0; i < count; ++i) {
    EXPECT_DOUBLE_EQ(recording.time[i], i / 200.0);
    EXPECT_EQ(recording.value[i], 20 + 100 * (i % 10)) << i;
  }
}

std::vector<std::string> CodesOf(const RecordedRun& recorded) {
  std::vector<std::string> codes;
  for (const Warning& warning : RecordWarnings(recorded)) codes.emplace_back(warning.code.text());
  return codes;
}

// ---- Normal ends -------------------------------------------------------------------------------------------------

TEST(RecordRun, RecordsForTheGivenSeconds) {
  Laboratory laboratory(WithSawtooth());
  laboratory.options.seconds = 2;
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.end, RunEnd::kSeconds);
  EXPECT_EQ(recorded.run.size(), 400);  // 0 to 1.995 s
  ExpectSawtooth(ReadBack(recorded.Csv()), 400);
  EXPECT_TRUE(IsComplete(recorded));
  EXPECT_THAT(CodesOf(recorded), IsEmpty());
  EXPECT_THAT(laboratory.board.Heard(), StartsWith("SX"));
}

// Frames have 8 samples; 0.104 s at 200 Hz contain the 21 samples at 0, 0.005, ..., 0.1 s.
TEST(RecordRun, RecordsNoMoreThanRequested) {
  Laboratory laboratory(WithSawtooth());
  laboratory.options.seconds = 0.104;
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.run.size(), 21);
  ExpectSawtooth(ReadBack(recorded.Csv()), 21);
}

TEST(RecordRun, DescribesTheRun) {
  Laboratory laboratory(WithSawtooth());
  laboratory.options.seconds = 0.2;
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.description.run, 42);  // the logger had been started 41 times
  EXPECT_THAT(recorded.description.begun, MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
  EXPECT_TRUE(recorded.description.losses->is_end_known);
  EXPECT_FALSE(recorded.description.clock.is_measured);  // much too short to measure the clock
  EXPECT_FALSE(recorded.description.calibration);
}

TEST(RecordRun, RecordsMeansWithTheirCalibration) {
  LoggerScript script;
  script.counts = [](double) { return 540; };
  Laboratory laboratory(script);
  laboratory.options.rate = {1250, 16};
  laboratory.options.seconds = 0.5;
  laboratory.calibration = Calibration();
  laboratory.calibration->input = "counts";
  laboratory.calibration->angle_unit = "deg";
  laboratory.calibration->coefficients = {-90, 0.25};
  ASSERT_TRUE(laboratory.logger.SetRate(laboratory.options.rate));
  const Recording recording = ReadBack(laboratory.Recorded().Csv());
  ASSERT_EQ(recording.size(), 50);
  EXPECT_NEAR(recording.value[0], 45 * kRadFromDeg, 1e-12);  // -90 + 0.25 * 540
  EXPECT_NEAR(recording.resolution, 0.25 / 16 * kRadFromDeg, 1e-12);
}

TEST(RecordRun, StopsOnRequest) {
  Laboratory laboratory(WithSawtooth());
  laboratory.board.At(0.5, [&] { laboratory.stop = true; });
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.end, RunEnd::kStopped);
  EXPECT_TRUE(IsComplete(recorded));   // including its End frame
  EXPECT_EQ(recorded.run.size(), 96);  // twelve frames in 0.5 s
  ExpectSawtooth(ReadBack(recorded.Csv()), static_cast<int>(recorded.run.size()));
}

// 300 counts that fall by 1/e in 3 s are half a count after 19 s; rest is certain 5 s later. The logger sends 40 s a
// second, so its clock cannot agree with the host's.
TEST(RecordRun, StopsAtRest) {
  LoggerScript script;
  script.frame_seconds = 0.001;
  script.counts = [](double t) {
    return static_cast<int>(std::lround(500 + 300 * std::exp(-t / 3) * std::cos(2 * std::numbers::pi * t / 1.5)));
  };
  Laboratory laboratory(script);
  laboratory.options.until_rest = true;
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.end, RunEnd::kRest);
  EXPECT_GT(recorded.run.size(), 200 * 15);
  EXPECT_LT(recorded.run.size(), 200 * 60);
  EXPECT_TRUE(recorded.description.clock.is_implausible);
  EXPECT_EQ(recorded.description.clock.scale, 1);
  EXPECT_THAT(CodesOf(recorded), ElementsAre("clock_implausible"));
  EXPECT_THAT(recorded.Csv(), HasSubstr("# clock_scale: 1\n# clock_scale_std_dev: 0.003\n"));
  EXPECT_THAT(RecordText(recorded, "run.csv"), HasSubstr("differ by more than any resonator"));
}

TEST(RecordRun, MeasuresAClockThatIsOnePercentFast) {
  LoggerScript script;
  script.frame_seconds = 0.04 / 1.01;
  Laboratory laboratory(script);
  laboratory.options.seconds = 11;
  const RecordedRun recorded = laboratory.Recorded();
  const DeviceClock& clock = recorded.description.clock;
  EXPECT_TRUE(clock.is_measured);
  EXPECT_NEAR(clock.scale, 1 / 1.01, 4 * clock.std_dev);
  EXPECT_LT(clock.std_dev, 60e-6);  // rounding to milliseconds: 1e-3 / √6 / 11
  EXPECT_THAT(CodesOf(recorded), IsEmpty());
  EXPECT_THAT(RecordText(recorded, "run.csv"), HasSubstr("ppm fast compared with this computer's"));
}

// ---- Abnormal ends -----------------------------------------------------------------------------------------------

RecordedRun RecordedUntil(Then then, Laboratory& laboratory) {
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.end, RunEnd::kLost) << static_cast<int>(then);
  EXPECT_FALSE(IsComplete(recorded));
  EXPECT_THAT(CodesOf(recorded), Contains("recording_interrupted"));
  ExpectSawtooth(ReadBack(recorded.Csv()), 80);
  ExpectSawtooth(ReadBack(laboratory.folder.Text("run.csv.part")), 80);
  return recorded;
}

/// A logger that sends ten frames, 80 samples, and then does `then`.
LoggerScript TenFramesAnd(Then then) {
  LoggerScript script = WithSawtooth();
  script.frames = 10;
  script.then = then;
  return script;
}

TEST(RecordRun, KeepsSamplesBeforeTheCableIsPulled) {
  Laboratory laboratory(TenFramesAnd(Then::kUnplugged));
  EXPECT_THAT(RecordedUntil(Then::kUnplugged, laboratory).loss_reason, HasSubstr("was disconnected"));
}

TEST(RecordRun, KeepsSamplesBeforeAReset) {
  Laboratory laboratory(TenFramesAnd(Then::kReset));
  EXPECT_THAT(RecordedUntil(Then::kReset, laboratory).loss_reason, HasSubstr("restarted"));
}

TEST(RecordRun, KeepsSamplesBeforeAnUnrequestedEnd) {
  Laboratory laboratory(TenFramesAnd(Then::kEnd));
  EXPECT_THAT(RecordedUntil(Then::kEnd, laboratory).loss_reason, HasSubstr("on its own"));
}

TEST(RecordRun, KeepsSamplesBeforeSilence) {
  Laboratory laboratory(TenFramesAnd(Then::kSilence));
  EXPECT_THAT(RecordedUntil(Then::kSilence, laboratory).loss_reason, HasSubstr("stopped sending"));
}

TEST(RecordRun, ReportsLostFramesAndKeepsTheTimes) {
  LoggerScript script = WithSawtooth();
  script.lost_frames = {5, 6};
  Laboratory laboratory(script);
  laboratory.options.seconds = 1;
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.end, RunEnd::kSeconds);
  EXPECT_EQ(recorded.run.size(), 200 - 16);
  EXPECT_EQ(recorded.description.losses->samples, 16);
  EXPECT_EQ(recorded.description.losses->on_line, 16);
  EXPECT_FALSE(IsComplete(recorded));
  EXPECT_THAT(CodesOf(recorded), ElementsAre("lost_samples"));
  const Recording recording = ReadBack(recorded.Csv());
  EXPECT_DOUBLE_EQ(recording.time[39], 0.195);
  EXPECT_DOUBLE_EQ(recording.time[40], 0.28);
  EXPECT_EQ(recording.value[40], Sawtooth(0.28));
}

TEST(RecordRun, DoesNotWaitForeverForTheEnd) {
  LoggerScript script = WithSawtooth();
  script.sends_end = false;
  Laboratory laboratory(script);
  laboratory.options.seconds = 0.5;
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_EQ(recorded.end, RunEnd::kSeconds);
  EXPECT_EQ(recorded.run.size(), 100);
  EXPECT_FALSE(recorded.description.losses->is_end_known);
  EXPECT_THAT(CodesOf(recorded), ElementsAre("end_message_missing"));
  EXPECT_THAT(recorded.Csv(), HasSubstr("end of the run did not arrive"));
}

// ---- No data -----------------------------------------------------------------------------------------------------

TEST(RecordRun, ReportsAnEmptyRecording) {
  LoggerScript script;
  script.frames = 0;
  Laboratory laboratory(script);
  const auto recorded = laboratory.Record();
  ASSERT_FALSE(recorded);
  EXPECT_EQ(recorded.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(recorded.error().message(), AllOf(HasSubstr("nothing was recorded"), HasSubstr("stopped sending")));
  EXPECT_THAT(laboratory.folder.Names(), IsEmpty());
}

TEST(RecordRun, CanBeStoppedBeforeAnythingArrives) {
  LoggerScript script;
  script.frames = 0;
  Laboratory laboratory(script);
  laboratory.board.At(0.3, [&] { laboratory.stop = true; });
  const auto recorded = laboratory.Record();
  ASSERT_FALSE(recorded);
  EXPECT_EQ(recorded.error().code, StatusCode::kTryAgain);
  EXPECT_THAT(laboratory.folder.Names(), IsEmpty());
}

// The part file may belong to an earlier recording that no new data has replaced.
TEST(RecordRun, ChangesNothingIfTheLoggerDoesNotStart) {
  LoggerScript script;
  script.refused = {{'S', pendulum_logger::kUnknown}};
  Laboratory laboratory(script);
  const auto recorded = laboratory.Record();
  ASSERT_FALSE(recorded);
  EXPECT_EQ(recorded.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(laboratory.folder.Names(), IsEmpty());
  laboratory.folder.Create("run.csv.part", "earlier");
  EXPECT_FALSE(laboratory.Record());
  EXPECT_EQ(laboratory.folder.Text("run.csv.part"), "earlier");
}

// ---- The copy on the disk ----------------------------------------------------------------------------------------

TEST(RecordRun, WritesAPartFileDuringTheRun) {
  Laboratory laboratory(WithSawtooth());
  std::string meanwhile;
  laboratory.board.At(2.5, [&] {
    meanwhile = laboratory.folder.Text("run.csv.part");
    laboratory.stop = true;
  });
  const RecordedRun recorded = laboratory.Recorded();
  EXPECT_THAT(meanwhile, EndsWith("\n"));  // complete rows
  const Recording recording = ReadBack(meanwhile);
  EXPECT_GT(recording.size(), 200);
  ExpectSawtooth(recording, static_cast<int>(recording.size()));
  EXPECT_EQ(ReadBack(laboratory.folder.Text("run.csv.part")).size(), recorded.run.size());
}

TEST(RecordRun, ContinuesIfThePartFileCannotBeWritten) {
  Laboratory laboratory(WithSawtooth());
  laboratory.options.out = laboratory.folder.Path("nowhere/run.csv");
  laboratory.options.seconds = 0.5;
  const RecordedRun recorded = laboratory.Recorded();
  ExpectSawtooth(ReadBack(recorded.Csv()), 100);
  EXPECT_THAT(recorded.part_file_error, HasSubstr("nowhere/run.csv.part"));
  EXPECT_THAT(CodesOf(recorded), ElementsAre("part_file_not_written"));
}

// Samples lost after the requested end do not belong to the recording.
TEST(RecordRun, CountsNoLossAfterTheRequestedEnd) {
  LoggerScript script = WithSawtooth();
  script.lost_frames = {13, 14, 15, 16};  // 0.5 s are frames 0 to 12
  Laboratory laboratory(script);
  laboratory.options.seconds = 0.5;
  const RecordedRun recorded = laboratory.Recorded();
  ExpectSawtooth(ReadBack(recorded.Csv()), 100);
  EXPECT_TRUE(IsComplete(recorded));
}

TEST(RecordRun, ContinuesIfTheDiskIsFull) {
  Laboratory laboratory(WithSawtooth());
  std::filesystem::create_symlink("/dev/full", laboratory.folder.Path("run.csv.part"));
  laboratory.options.seconds = 0.5;
  const RecordedRun recorded = laboratory.Recorded();
  ExpectSawtooth(ReadBack(recorded.Csv()), 100);
  EXPECT_THAT(recorded.part_file_error, HasSubstr("No space left"));
  EXPECT_THAT(CodesOf(recorded), ElementsAre("part_file_not_written"));
}

TEST(RecordRun, HasNoPartFileForAStream) {
  Laboratory laboratory(WithSawtooth());
  laboratory.options.out = "-";
  laboratory.options.seconds = 0.2;
  EXPECT_EQ(laboratory.Recorded().part_file_error, "");
  EXPECT_THAT(laboratory.folder.Names(), IsEmpty());
}

}  // namespace
}  // namespace pendulum::record_run_test
