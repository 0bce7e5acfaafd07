// SPDX-License-Identifier: Apache-2.0
#include "tools/record_pendulum_options.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::record_pendulum_options_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using Flags = RecordPendulumFlags;

Flags Recording() {
  Flags flags;
  flags.out = "run.csv";
  return flags;
}

/// The options for valid flags.
RecordPendulumOptions Made(const Flags& flags) {
  const auto options = MakeRecordPendulumOptions(flags);
  EXPECT_TRUE(options) << options.error().message();
  return options.value_or(RecordPendulumOptions());
}

// ---- Recording ---------------------------------------------------------------------------------------------------

TEST(MakeRecordPendulumOptions, RecordsUntilStoppedByDefault) {
  const RecordPendulumOptions options = Made(Recording());
  EXPECT_EQ(options.task, RecordTask::kRecord);
  EXPECT_EQ(options.out, "run.csv");
  EXPECT_EQ(options.port, "");
  EXPECT_EQ(options.calibration, "");
  EXPECT_FALSE(options.seconds);
  EXPECT_FALSE(options.until_rest);
  EXPECT_FALSE(options.overwrite);
  EXPECT_FALSE(options.fit);
  EXPECT_EQ(options.rate.Hz(), 200);
  EXPECT_EQ(options.rate.oversample, 1);
  EXPECT_EQ(options.baud, 115200);
}

TEST(MakeRecordPendulumOptions, AcceptsEveryFlagOfARecording) {
  Flags flags = Recording();
  flags.port = "/dev/ttyACM1";
  flags.seconds = "12.5";
  flags.until_rest = true;
  flags.overwrite = true;
  flags.rate_hz = 100;
  flags.oversample = 16;
  flags.baud = 500000;
  flags.calibration = "cal.json";
  const RecordPendulumOptions options = Made(flags);
  EXPECT_EQ(options.port, "/dev/ttyACM1");
  EXPECT_EQ(options.seconds, 12.5);
  EXPECT_TRUE(options.until_rest);
  EXPECT_TRUE(options.overwrite);
  EXPECT_EQ(options.rate.period, 1250);  // 2 MHz / 1600 conversions a second
  EXPECT_EQ(options.rate.oversample, 16);
  EXPECT_EQ(options.baud, 500000);
  EXPECT_EQ(options.calibration, "cal.json");
}

TEST(MakeRecordPendulumOptions, ListsItsInputAndOutputFiles) {
  Flags flags = Recording();
  flags.calibration = "cal.json";
  flags.fit = true;
  flags.rig = "rig.json";
  const RecordPendulumOptions options = Made(flags);
  ASSERT_THAT(options.Outputs(), SizeIs(1));
  EXPECT_EQ(options.Outputs()[0].flag, "--out");
  EXPECT_EQ(options.Outputs()[0].path, "run.csv");
  ASSERT_THAT(options.Inputs(), SizeIs(2));
  EXPECT_EQ(options.Inputs()[0].flag, "--calibration");
  EXPECT_EQ(options.Inputs()[0].path, "cal.json");
  EXPECT_EQ(options.Inputs()[1].flag, "--rig");
  EXPECT_EQ(options.Inputs()[1].path, "rig.json");
  EXPECT_THAT(Made(Recording()).Inputs(), IsEmpty());
}

TEST(MakeRecordPendulumOptions, AcceptsTheLowestAndHighestRates) {
  Flags flags = Recording();
  for (const double rate : {32.0, 8000.0}) {
    flags.rate_hz = rate;
    EXPECT_EQ(Made(flags).rate.Hz(), rate);
  }
  flags.oversample = 64;
  for (const double rate : {0.5, 125.0}) {
    flags.rate_hz = rate;
    EXPECT_EQ(Made(flags).rate.Hz(), rate);
  }
}

// ---- Fits --------------------------------------------------------------------------------------------------------

TEST(MakeRecordPendulumOptions, FitsTheRecording) {
  Flags flags = Recording();
  flags.fit = true;
  flags.rig = "rig.json";
  flags.model = "viscous";
  const RecordPendulumOptions options = Made(flags);
  ASSERT_TRUE(options.fit);
  EXPECT_THAT(options.fit->data, ElementsAre("run.csv"));
  EXPECT_EQ(options.fit->rig, "rig.json");
}

// fit_pendulum splits --data at commas, but record_pendulum fits the one file that it has written.
TEST(MakeRecordPendulumOptions, FitsAFileWithCommasInItsName) {
  for (const char* name : {"5 deg, short.csv", "a,,b.csv", "last,", "-,-"}) {
    Flags flags = Recording();
    flags.out = name;
    flags.fit = true;
    const auto options = MakeRecordPendulumOptions(flags);
    ASSERT_TRUE(options) << options.error().message();
    ASSERT_TRUE(options->fit);
    EXPECT_THAT(options->fit->data, ElementsAre(name));
  }
}

// ---- Other tasks -------------------------------------------------------------------------------------------------

TEST(MakeRecordPendulumOptions, StoresACalibration) {
  Flags flags;
  flags.store_calibration = "cal.json";
  flags.port = "/dev/ttyUSB0";
  flags.baud = 1000000;
  const RecordPendulumOptions options = Made(flags);
  EXPECT_EQ(options.task, RecordTask::kStoreCalibration);
  EXPECT_EQ(options.calibration, "cal.json");
  EXPECT_EQ(options.port, "/dev/ttyUSB0");
  EXPECT_EQ(options.baud, 1000000);
  EXPECT_THAT(options.Outputs(), IsEmpty());
  ASSERT_THAT(options.Inputs(), SizeIs(1));
  EXPECT_EQ(options.Inputs()[0].path, "cal.json");
}

// The user gave --store_calibration, so the file's flag in messages must not be --calibration.
TEST(MakeRecordPendulumOptions, NamesTheFlagForTheStoredCalibration) {
  Flags flags;
  flags.store_calibration = "cal.json";
  const RecordPendulumOptions options = Made(flags);
  ASSERT_THAT(options.Inputs(), SizeIs(1));
  EXPECT_EQ(options.Inputs()[0].flag, "--store_calibration");
}

TEST(MakeRecordPendulumOptions, AcceptsTheTasksInfoCountsAndList) {
  Flags flags;
  flags.info = true;
  EXPECT_EQ(Made(flags).task, RecordTask::kInfo);
  flags.info = false;
  flags.counts = true;
  EXPECT_EQ(Made(flags).task, RecordTask::kCounts);
  EXPECT_EQ(Made(flags).seconds, 1);  // duration of the averaged readings
  flags.counts = false;
  flags.list = true;
  EXPECT_EQ(Made(flags).task, RecordTask::kList);
  EXPECT_THAT(Made(flags).Outputs(), IsEmpty());
  EXPECT_THAT(Made(flags).Inputs(), IsEmpty());
}

// ---- Refusals ----------------------------------------------------------------------------------------------------

struct Refusal {
  std::string message;
  void (*spoil)(Flags&);
};

void ExpectRefusals(const Flags& good, const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) {
    Flags flags = good;
    refusal.spoil(flags);
    const auto options = MakeRecordPendulumOptions(flags);
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(options.error().message(), HasSubstr(refusal.message));
  }
}

TEST(MakeRecordPendulumOptions, RequiresExactlyOneTask) {
  ExpectRefusals(Recording(), {{"--out is missing", [](Flags& f) { f.out.clear(); }},
                               {"give only one of", [](Flags& f) { f.list = true; }},
                               {"give only one of", [](Flags& f) { f.info = true; }},
                               {"give only one of", [](Flags& f) { f.counts = true; }},
                               {"give only one of", [](Flags& f) { f.store_calibration = "cal.json"; }},
                               {"give only one of", [](Flags& f) { f.out.clear(), f.list = f.info = true; }},
                               {"'run.csv' does not belong to a flag", [](Flags& f) { f.positional = {"run.csv"}; }}});
}

TEST(MakeRecordPendulumOptions, RefusesWrongNumbers) {
  ExpectRefusals(Recording(),
                 {{"--rate_hz is 9000; with --oversample 1 it must be 32 to 8000", [](Flags& f) { f.rate_hz = 9000; }},
                  {"--rate_hz is 31; with", [](Flags& f) { f.rate_hz = 31; }},
                  {"--rate_hz is 0; with", [](Flags& f) { f.rate_hz = 0; }},
                  {"--rate_hz is -200", [](Flags& f) { f.rate_hz = -200; }},
                  {"--rate_hz is nan", [](Flags& f) { f.rate_hz = std::nan(""); }},
                  {"with --oversample 64 it must be 0.5 to 125", [](Flags& f) { f.oversample = 64; }},
                  {"--oversample is 0; it must be 1 to 64", [](Flags& f) { f.oversample = 0; }},
                  {"--oversample is 65; it must be 1 to 64", [](Flags& f) { f.oversample = 65; }},
                  {"--baud is 0; it must be", [](Flags& f) { f.baud = 0; }},
                  {"--baud is -9600; it must be", [](Flags& f) { f.baud = -9600; }},
                  {"--baud is 3000000; it must be", [](Flags& f) { f.baud = 3000000; }},
                  {"--seconds is 'x'; it must be a number", [](Flags& f) { f.seconds = "x"; }},
                  {"--seconds is '10 s'; it must be", [](Flags& f) { f.seconds = "10 s"; }},
                  {"--seconds is 'nan'; it must be", [](Flags& f) { f.seconds = "nan"; }},
                  {"--seconds is 0; it must be positive", [](Flags& f) { f.seconds = "0"; }},
                  {"--seconds is 0.001, less than a sample takes", [](Flags& f) { f.seconds = "0.001"; }},
                  {"--seconds is -5; it must be positive", [](Flags& f) { f.seconds = "-5"; }},
                  {"--seconds is 1e9; it must be", [](Flags& f) { f.seconds = "1e9"; }}});
}

TEST(MakeRecordPendulumOptions, RefusesAFitWithoutARecording) {
  ExpectRefusals(Recording(), {{"--rig belongs to a fit; add --fit", [](Flags& f) { f.rig = "rig.json"; }},
                               {"--model belongs to a fit; add --fit", [](Flags& f) { f.model = "all"; }},
                               {"--fit needs a recording in a file", [](Flags& f) { f.fit = true, f.out = "-"; }},
                               {"--fit needs a recording", [](Flags& f) { f.fit = true, f.out = "/dev/stdout"; }},
                               {"no_such_model", [](Flags& f) { f.fit = true, f.model = "no_such_model"; }}});
}

TEST(MakeRecordPendulumOptions, RefusesRecordingFlagsForOtherTasks) {
  const std::vector<Refusal> refusals = {
      {"--seconds belongs to a recording; add --out", [](Flags& f) { f.seconds = "5"; }},
      {"--until_rest belongs to a recording", [](Flags& f) { f.until_rest = true; }},
      {"--overwrite belongs to a recording", [](Flags& f) { f.overwrite = true; }},
      {"--fit belongs to a recording", [](Flags& f) { f.fit = true; }},
      {"--calibration belongs to a recording", [](Flags& f) { f.calibration = "cal.json"; }},
      {"--rig belongs to a recording", [](Flags& f) { f.rig = "rig.json"; }},
      {"--model belongs to a recording", [](Flags& f) { f.model = "all"; }},
      {"--rate_hz belongs to a recording", [](Flags& f) { f.rate_hz = 100; }},
      {"--oversample belongs to a recording", [](Flags& f) { f.oversample = 2; }},
      {"--baud is 5; it must be", [](Flags& f) { f.baud = 5; }}};
  Flags list, info, store, counts;
  counts.counts = true;
  list.list = true;
  info.info = true;
  store.store_calibration = "cal.json";
  for (const Flags& good : {list, info, store, counts}) ExpectRefusals(good, refusals);
}

// ---- LineCapacityHz ----------------------------------------------------------------------------------------------

// 10 bits per byte. 16 samples are a payload of 44 bytes, and 48 with CRC, COBS and 0: 11 520 / 48 * 16 = 3840 Hz. 8
// samples (200 Hz, 25 frames per second) are 32 bytes: 2880 Hz. A single sample has 18 bytes: 640 Hz.
TEST(LineCapacityHz, CountsWholeFrames) {
  EXPECT_DOUBLE_EQ(LineCapacityHz({500, 1}, 115200), 3840);
  EXPECT_DOUBLE_EQ(LineCapacityHz({500, 1}, 1000000), 1000000.0 / 480 * 16);
  EXPECT_DOUBLE_EQ(LineCapacityHz({10000, 1}, 115200), 2880);
  EXPECT_DOUBLE_EQ(LineCapacityHz({62500, 64}, 115200), 640);
}

}  // namespace
}  // namespace pendulum::record_pendulum_options_test
