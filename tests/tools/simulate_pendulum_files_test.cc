// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_files.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "tests/tools/temporary_folder.h"

namespace pendulum::simulate_pendulum_files_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using testing::UnorderedElementsAre;

/// Recordings of 20 samples.
class WriteRecordingsTest : public testing::Test {
 protected:
  WriteRecordingsTest() {
    flags_.set = "inertia=0.04,release_angle=0.25,release_time=0.05";
    flags_.duration = 0.2;
    flags_.noise = 0.1;
    flags_.count = 3;
    flags_.out = folder_.Path("run.csv");
  }

  Result<void> Write() const {
    const auto options = MakeSimulateOptions(flags_, {});
    EXPECT_TRUE(options) << options.error().message();
    return WriteRecordings(*options);
  }

  void Make() const {
    const auto written = Write();
    ASSERT_TRUE(written) << written.error().message();
  }

  std::string Refused(StatusCode code) const {
    const auto written = Write();
    EXPECT_FALSE(written);
    if (written) return "";
    EXPECT_EQ(written.error().code, code);
    return written.error().message();
  }

  TemporaryFolder folder_;
  SimulateFlags flags_;
};

TEST_F(WriteRecordingsTest, WritesRecordingsTruthAndManifest) {
  flags_.truth = folder_.Path("truth.json");
  flags_.manifest = folder_.Path("runs.csv");
  Make();
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("run_001.csv", "run_002.csv", "run_003.csv", "truth_001.json",
                                                    "truth_002.json", "truth_003.json", "runs.csv"));
  const auto read = ReadRecording(folder_.Path("run_002.csv"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->size(), 20);
  EXPECT_THAT(folder_.Text("runs.csv"), AllOf(HasSubstr("\nrun_002.csv,run_002,2,0.04,"), EndsWith(",0.05,0\n")));
}

TEST_F(WriteRecordingsTest, WritesTheSameOnAnyNumberOfThreads) {
  flags_.count = 40;
  flags_.spread = "inertia=0.002,zero_angle=0.01";
  flags_.threads = 1;
  Make();
  flags_.out = folder_.Path("again.csv");
  flags_.threads = 5;
  Make();
  for (int i = 0; i < flags_.count; ++i) {
    EXPECT_EQ(folder_.Text(NumberedPath("again.csv", i, 40)), folder_.Text(NumberedPath("run.csv", i, 40)));
  }
}

TEST_F(WriteRecordingsTest, RefusesUnwritablePathsBeforeTheWork) {
  flags_.count = 2000;
  fs::create_directory(folder_.Path("run_1500.csv"));
  EXPECT_EQ(Refused(StatusCode::kCannotWrite), "cannot write " + folder_.Path("run_1500.csv") + ": it is a directory");
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("run_1500.csv"));
}

TEST_F(WriteRecordingsTest, RefusesAManifestOrARigThatARecordingWouldReplace) {
  flags_.count = 2000;
  flags_.manifest = folder_.Path("./run_1500.csv");
  EXPECT_EQ(Refused(StatusCode::kInvalidArgument),
            "--out " + folder_.Path("run_1500.csv") + " is the output of --manifest too");
  flags_.manifest.clear();
  folder_.Create("run_0007.csv", "rig");
  flags_.rig = folder_.Path("run_0007.csv");
  EXPECT_EQ(Refused(StatusCode::kInvalidArgument),
            "--out " + folder_.Path("run_0007.csv") + " would overwrite the input of --rig");
  EXPECT_THAT(folder_.Names(), UnorderedElementsAre("run_0007.csv"));
}

TEST_F(WriteRecordingsTest, ReplacesExistingFiles) {
  folder_.Create("run_002.csv", "old");
  Make();
  EXPECT_THAT(folder_.Text("run_002.csv"), StartsWith("# simulate_pendulum "));
}

TEST_F(WriteRecordingsTest, NamesTheFirstSeedThatFailsAndWritesNoManifest) {
  flags_.count = 30;
  flags_.manifest = folder_.Path("runs.csv");
  flags_.set += ",coulomb=0.2";  // sin 0.25 = 0.247: with more dry friction the pendulum does not move
  flags_.spread = "coulomb=0.05";
  flags_.threads = 1;
  const std::string alone = Refused(StatusCode::kFailedPrecondition);
  EXPECT_THAT(alone, AllOf(StartsWith("seed "), HasSubstr(": friction holds the pendulum")));
  flags_.threads = 4;
  EXPECT_EQ(Refused(StatusCode::kFailedPrecondition), alone);
  EXPECT_FALSE(fs::exists(folder_.Path("runs.csv")));
}

}  // namespace
}  // namespace pendulum::simulate_pendulum_files_test
