// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/identify/identify.h"
#include "pendulum/identify/prepared_recording.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/report/json.h"
#include "tests/batch/small_batch.h"

namespace pendulum::identify_bytes_test {
namespace {

using small_batch::OptionsFor;
using testing::HasSubstr;
using testing::StartsWith;

std::string FileText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr const char* kCalibration =
    R"({"input": "counts", "angle_unit": "deg", "coefficients": [-50, 0.2], "input_range": [0, 1023]})";

/// A short swing in counts of a sensor with the calibration kCalibration.
std::string CountsText() {
  SyntheticOptions truth = small_batch::Truth(1);
  const auto recording = SimulateRecording(truth);
  std::string text = "time_s,adc_counts\n";
  for (Eigen::Index i = 0; i < recording->size(); ++i) {
    constexpr double kCountsPerRad = 180 / 3.14159265358979 / 0.2;
    text += std::to_string(recording->time[i]) + "," +
            std::to_string(std::lround(250 + recording->value[i] * kCountsPerRad)) + "\n";
  }
  return text;
}

Status FaultOf(const IdentifyOptions& options, RunFiles files) {
  const auto run = IdentifyBytes(options, std::move(files));
  EXPECT_FALSE(run);
  return run ? Status{StatusCode::kInternal, ""} : run.error();
}

// The expected result comes from the functions with which fit_pendulum reads and fits files.
TEST(IdentifyBytes, EqualsTheFitOfTheFiles) {
  const IdentifyOptions options = OptionsFor({"viscous", "coulomb"});
  const std::string data = "datasets/textbook_rig.csv", rig = "datasets/textbook_rig.json";
  const auto from_bytes = IdentifyBytes(options, {{data, FileText(data)}, Share({rig, FileText(rig)}), {}});
  ASSERT_TRUE(from_bytes) << from_bytes.error().message();
  auto one = PrepareFile(data, options, ReadRig(rig).value());
  ASSERT_TRUE(one) << one.error().message();
  const auto from_files = IdentifyEach(options, *std::move(one));
  ASSERT_TRUE(from_files.at(0)) << from_files[0].error().message();
  EXPECT_EQ(ToJson(*from_bytes).dump(2), ToJson(*from_files[0]).dump(2));
  EXPECT_EQ(from_bytes->recordings.front().used.time, from_files[0]->recordings.front().used.time);
}

TEST(IdentifyBytes, EqualsTheFitOfTheFilesWithACalibration) {
  const small_batch::Folder folder("fit_bytes");
  folder.Write("counts.csv", CountsText());
  folder.Write("calibration.json", kCalibration);
  IdentifyOptions options = OptionsFor({"viscous"});
  const std::string data = folder / "counts.csv";
  const auto from_bytes = IdentifyBytes(options, {{data, CountsText()}, {}, Share({"calibration", kCalibration})});
  ASSERT_TRUE(from_bytes) << from_bytes.error().message();
  options.read.calibration = ReadCalibration(folder / "calibration.json").value();
  auto one = PrepareFile(data, options, std::nullopt);
  ASSERT_TRUE(one) << one.error().message();
  const auto from_files = IdentifyEach(options, *std::move(one));
  ASSERT_TRUE(from_files.at(0)) << from_files[0].error().message();
  EXPECT_EQ(ToJson(*from_bytes).dump(2), ToJson(*from_files[0]).dump(2));
}

TEST(IdentifyBytes, NamesTheFaultyFileAndPlace) {
  const IdentifyOptions options = OptionsFor({"viscous"});
  const std::string good = small_batch::RecordingText(1);
  const Status data = FaultOf(options, {{"a.csv", "time_s,angle_rad\n0,1\n0.1,soon\n0.2,1\n"}, {}, {}});
  EXPECT_EQ(data.code, StatusCode::kDataLoss);
  EXPECT_THAT(data.message(), StartsWith("a.csv:3:5: "));
  const Status rig = FaultOf(options, {{"a.csv", good}, Share({"my rig", "{"}), {}});
  EXPECT_EQ(rig.code, StatusCode::kDataLoss);
  EXPECT_THAT(rig.message(), StartsWith("my rig:1:"));
  const Status calibration = FaultOf(options, {{"a.csv", good}, {}, Share({"cal", "[]"})});
  EXPECT_EQ(calibration.code, StatusCode::kDataLoss);
  EXPECT_THAT(calibration.message(), StartsWith("cal: "));
}

TEST(IdentifyBytes, ReportsThatNothingSwings) {
  std::string rest = "time_s,angle_rad\n";
  for (int i = 0; i < 100; ++i) rest += std::to_string(i) + ",0\n";
  const Status fault = FaultOf(OptionsFor({"viscous"}), {{"rest.csv", rest}, {}, {}});
  EXPECT_EQ(fault.code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(fault.message(), HasSubstr("no swing"));
}

}  // namespace
}  // namespace pendulum::identify_bytes_test
