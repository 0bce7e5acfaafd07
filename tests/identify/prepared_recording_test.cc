// SPDX-License-Identifier: Apache-2.0
#include "pendulum/identify/prepared_recording.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "pendulum/identify/identify.h"
#include "pendulum/recording/sensor_statement.h"

namespace pendulum::prepared_recording_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

// ---- ErrorOfRun ----------------------------------------------------------------------------------------------------

std::string MessageAmong(const std::string& place, const std::string& path, int release) {
  const Status status = ErrorOfRun({StatusCode::kFailedPrecondition, "no swing", place}, path, release).value();
  EXPECT_EQ(status.code, StatusCode::kFailedPrecondition);
  return status.message();
}

TEST(ErrorOfRun, NamesTheRecordingOnce) {
  EXPECT_EQ(MessageAmong("", "a.csv", 0), "a.csv: no swing");
  EXPECT_EQ(MessageAmong("a.csv", "a.csv", 0), "a.csv: no swing");
  EXPECT_EQ(MessageAmong("a.csv:7", "a.csv", 0), "a.csv:7: no swing");
  EXPECT_EQ(MessageAmong("a.csv: # rig", "a.csv", 0), "a.csv: # rig: no swing");
  EXPECT_EQ(MessageAmong("rig.json", "a.csv", 0), "a.csv: rig.json: no swing");
  EXPECT_EQ(MessageAmong("", "-", 0), "standard input: no swing");
}

TEST(ErrorOfRun, NamesTheReleaseAfterTheRecording) {
  EXPECT_EQ(MessageAmong("", "a.csv", 2), "a.csv: free swing 2: no swing");
  EXPECT_EQ(MessageAmong("a.csv", "a.csv", 2), "a.csv: free swing 2: no swing");
  EXPECT_EQ(MessageAmong("a.csv: # rig", "a.csv", 2), "a.csv: free swing 2: # rig: no swing");
  EXPECT_EQ(MessageAmong("rig.json", "a.csv", 2), "a.csv: free swing 2: rig.json: no swing");
}

// ---- PrepareFile ---------------------------------------------------------------------------------------------------

/// A copy of datasets/runs_1.csv with an additional first line.
class PrepareFileTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  Result<PreparedRecording> Read(const std::string& line, const std::optional<Rig>& rig = std::nullopt) const {
    std::ofstream(path_) << line << '\n' << std::ifstream("datasets/runs_1.csv").rdbuf();
    return PrepareFile(path_, {}, rig);
  }

  /// The names of the effects in the result of the fit of such a copy, with their sizes and sources, and the warnings.
  std::string SensorOf(const std::string& line, const std::string& given) const {
    std::ifstream rows("datasets/runs_1.csv");
    std::string text = line + '\n';
    for (std::string row; std::getline(rows, row);) text += row.starts_with("# sensor") ? "" : row + '\n';
    std::ofstream(path_) << text;
    IdentifyOptions options;
    options.models = {"coulomb"};
    options.closed_form_only = true;
    if (!given.empty()) options.sensor = ParseSensorStatement(given, "x", "given by --sensor").value();
    auto prepared = PrepareFile(path_, options, std::nullopt);
    const auto result = IdentifyEach(options, *std::move(prepared));
    const SensorErrors& sensor = result.front().value().recordings.front().data.sensor;
    std::string summary = sensor.kind + ", gain: " + sensor.Of(SensorEffect::kGain).SourceText();
    for (const Warning& warning : result.front()->recordings.front().warnings)
      summary += ", " + std::string(warning.code.text());
    return summary;
  }

  const std::string path_ = testing::TempDir() + "prepared_recording_test_" + std::to_string(getpid()) + ".csv";
};

TEST_F(PrepareFileTest, UsesTheRigDescribedByTheRecording) {
  const auto one = Read(R"(# rig: {"gravity_torque": {"value": 1.8, "std_dev": 0.01}})");
  ASSERT_TRUE(one) << one.error().message();
  ASSERT_TRUE(one->rig);
  EXPECT_EQ(one->rig->gravity_torque.value, 1.8);
  EXPECT_EQ(one->rig->gravity_torque.std_dev, 0.01);
  EXPECT_EQ(one->samples, 1500);  // 15 s at 100 Hz (src/docs/examples.md)
  EXPECT_THAT(one->swings.chosen, ElementsAre(1));
  EXPECT_THAT(one->recording.warnings, IsEmpty());  // they are in `known`
}

TEST_F(PrepareFileTest, PrefersAGivenRig) {
  const auto one = Read(R"(# rig: {"gravity_torque": 1.8})", Rig{{2.5, 0}, {}, {}});
  ASSERT_TRUE(one) << one.error().message();
  EXPECT_EQ(one->rig->gravity_torque.value, 2.5);
}

TEST_F(PrepareFileTest, NamesWrongRigMetadata) {
  const auto one = Read(R"(# rig: {"gravity_torque": -1})");
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(one.error().message(), StartsWith(path_ + ": # rig"));
}

TEST_F(PrepareFileTest, DecidesTheSensor) {
  EXPECT_EQ(SensorOf("# a comment", ""), "angle sensor, gain: assumed for an angle sensor");
  EXPECT_EQ(SensorOf("# sensor: encoder", ""), "encoder, gain: assumed for an encoder");
  EXPECT_EQ(SensorOf("# a comment", R"({"gain": 0.01})"), "angle sensor, gain: given by --sensor");
  EXPECT_EQ(SensorOf("# sensor: encoder", "ideal"), "ideal, gain: given by --sensor, sensor_replaced");
}

TEST_F(PrepareFileTest, HasNoRigWithoutADescription) {
  const auto one = Read("# a comment");
  ASSERT_TRUE(one) << one.error().message();
  EXPECT_FALSE(one->rig);
}

}  // namespace
}  // namespace pendulum::prepared_recording_test
