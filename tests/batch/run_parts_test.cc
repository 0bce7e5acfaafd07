// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/run_parts.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace pendulum::run_parts_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

// ---- ErrorAmong ----------------------------------------------------------------------------------------------------

std::string MessageAmong(const std::string& message, const std::string& path, int release) {
  const Status status = ErrorAmong({StatusCode::kFailedPrecondition, message}, path, release).value();
  EXPECT_EQ(status.code, StatusCode::kFailedPrecondition);
  return status.message;
}

TEST(ErrorAmong, NamesTheRecordingOnce) {
  EXPECT_EQ(MessageAmong("no swing", "a.csv", 0), "a.csv: no swing");
  EXPECT_EQ(MessageAmong("a.csv: no swing", "a.csv", 0), "a.csv: no swing");
  EXPECT_EQ(MessageAmong("a.csv:7: no number", "a.csv", 0), "a.csv:7: no number");
  EXPECT_EQ(MessageAmong("no swing", "-", 0), "standard input: no swing");
}

TEST(ErrorAmong, NamesTheReleaseBehindTheRecording) {
  EXPECT_EQ(MessageAmong("no swing", "a.csv", 2), "a.csv: free swing 2: no swing");
  EXPECT_EQ(MessageAmong("a.csv: no swing", "a.csv", 2), "a.csv: free swing 2: no swing");
}

// ---- ReadOne -------------------------------------------------------------------------------------------------------

/// A copy of datasets/runs_1.csv with a line in front of it.
class ReadOneTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  Result<ReadSwings> Read(const std::string& line, const std::optional<Rig>& rig = std::nullopt) const {
    std::ofstream(path_) << line << '\n' << std::ifstream("datasets/runs_1.csv").rdbuf();
    return ReadOne({}, path_, rig);
  }

  const std::string path_ = testing::TempDir() + "run_parts_test_" + std::to_string(getpid()) + ".csv";
};

TEST_F(ReadOneTest, TakesTheRigThatTheRecordingDescribes) {
  const auto one = Read(R"(# rig: {"gravity_torque": {"value": 1.8, "std_dev": 0.01}})");
  ASSERT_TRUE(one) << one.error().message;
  ASSERT_TRUE(one->common.rig);
  EXPECT_EQ(one->common.rig->gravity_torque.value, 1.8);
  EXPECT_EQ(one->common.rig->gravity_torque.std_dev, 0.01);
  EXPECT_EQ(one->samples, 1500);  // 15 s at 100 Hz (datasets/README.md)
  EXPECT_THAT(one->swings.chosen, ElementsAre(1));
  EXPECT_THAT(one->recording.warnings, IsEmpty());  // they are the report's
}

TEST_F(ReadOneTest, PrefersTheRigThatIsGiven) {
  const auto one = Read(R"(# rig: {"gravity_torque": 1.8})", Rig{{2.5, 0}, {}, {}});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->common.rig->gravity_torque.value, 2.5);
}

TEST_F(ReadOneTest, NamesTheMetadataOfARigThatIsWrong) {
  const auto one = Read(R"(# rig: {"gravity_torque": -1})");
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(one.error().message, StartsWith(path_ + ": # rig"));
}

TEST_F(ReadOneTest, HasNoRigWhereNoneIsDescribed) {
  const auto one = Read("# a comment");
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_FALSE(one->common.rig);
}

// ---- AddSampling ---------------------------------------------------------------------------------------------------

/// 100 samples at 50 Hz, on a clock whose seconds are so many true ones.
Recording EvenSamples(double clock_scale) {
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(100, 0, 1.98);
  recording.value = (5 * recording.time.array()).sin();
  recording.clock_scale = clock_scale;
  return recording;
}

TEST(AddSampling, TakesTheFrequencyFromTheHalfPeriodOfTheSwing) {
  FreeSwing swing;
  swing.half_period = 0.625;
  RunReport report;
  AddSampling(swing, EvenSamples(1), report);
  ASSERT_TRUE(report.sampling);
  EXPECT_NEAR(report.sampling->rate_hz, 50, 1e-9);
  EXPECT_DOUBLE_EQ(report.sampling->frequency_hz, 0.8);  // 1 / (2 · 0.625)
  EXPECT_FALSE(report.sampling->expected_frequency_hz);
}

// sqrt(G / I_O) / 2π = sqrt(1.8 / 0.05) / 2π = 6 / 2π Hz in true seconds; 1.1 times as many cycles in one of the
// file's.
TEST(AddSampling, ExpectsTheFrequencyOfTheRigOnTheClockOfTheFile) {
  FreeSwing swing;
  swing.half_period = 0.625;
  RunReport report;
  report.rig = Rig{{1.8, 0}, RigValue{0.05, 0}, {}};
  AddSampling(swing, EvenSamples(1.1), report);
  ASSERT_TRUE(report.sampling && report.sampling->expected_frequency_hz);
  EXPECT_NEAR(*report.sampling->expected_frequency_hz, 1.1 * 6 / (2 * 3.14159265358979), 1e-12);
}

TEST(AddSampling, KnowsNoFrequencyOfASwingWithoutTurningPoints) {
  RunReport report;
  AddSampling(FreeSwing(), EvenSamples(1), report);
  ASSERT_TRUE(report.sampling);
  EXPECT_EQ(report.sampling->frequency_hz, 0);
}

}  // namespace
}  // namespace pendulum::run_parts_test
