// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/simulation_text.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/recording/readers/read_recording.h"

namespace pendulum::simulation_text_test {
namespace {

using testing::DoubleEq;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

constexpr double kRadPerDeg = 0.017453292519943295;  // π / 180

/// The simulation for these flags, with a release angle of 0.3 rad.
Simulation Options(SimulationFlags flags = {}) {
  flags.set = "inertia=0.04,coulomb=0.001,release_angle=0.3,release_time=0.5";
  const Result<Simulation> options = MakeSimulation(flags, {});
  EXPECT_TRUE(options) << options.error().message();
  return *options;
}

Recording Simulated(const Simulation& options) {
  const Result<Recording> recording = SimulateRecording(options.synthetic);
  EXPECT_TRUE(recording) << recording.error().message();
  return *recording;
}

/// The texts in a CSV file's value column.
std::vector<std::string> ValueFields(const std::string& csv) {
  std::vector<std::string> fields;
  std::size_t at = csv.find("time_s,");
  while ((at = csv.find('\n', at) + 1) < csv.size()) {
    const std::size_t comma = csv.find(',', at);
    fields.push_back(csv.substr(comma + 1, csv.find('\n', comma) - comma - 1));
  }
  return fields;
}

TEST(RecordingCsv, ReadsBackIdentically) {
  for (const std::string unit : {"deg", "rad", "deg_s", "rad_s"}) {
    SimulationFlags flags;
    flags.unit = unit;
    flags.noise = 0.01;
    flags.jitter = 0.001;
    const Simulation options = Options(flags);
    const Recording recording = Simulated(options);
    const Result<Recording> read = ParseRecording(RecordingCsv(options, recording, 1), "run.csv");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->quantity, recording.quantity);
    EXPECT_EQ(read->time, recording.time);
    EXPECT_TRUE(read->value.isApprox(recording.value, 1e-15)) << unit;
    EXPECT_EQ(read->resolution, 0);
  }
}

TEST(RecordingCsv, ContainsItsOriginAndTheSensorsUnit) {
  SimulationFlags flags;
  flags.resolution = 0.1985;
  flags.range = "-49.6077,153.4578";
  const Simulation options = Options(flags);
  const std::string csv = RecordingCsv(options, Simulated(options), 7);
  EXPECT_THAT(csv, StartsWith("# simulate_pendulum "));
  EXPECT_THAT(csv, HasSubstr(", model coulomb, gravity sin, seed 7\n# resolution: 0.1985\n"
                             "# range: -49.6077,153.4578\n# sensor: {\"kind\":\"ideal\"}\ntime_s,angle_deg\n0,"));
  const Result<Recording> read = ParseRecording(csv, "run.csv");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_THAT(read->resolution, DoubleEq(0.1985 * kRadPerDeg));
}

// 0.3 rad = 17.1887 deg; (17.1887 + 49.6077) / 0.1985 = 336.51, and level 337 is -49.6077 + 66.8945 = 17.2868 deg.
TEST(RecordingCsv, PrintsTheLevelsOfADecimalSensorAsDecimals) {
  SimulationFlags flags;
  flags.resolution = 0.1985;
  flags.range = "-49.6077,153.4578";
  const Simulation options = Options(flags);
  const std::string csv = RecordingCsv(options, Simulated(options), 1);
  EXPECT_THAT(csv, HasSubstr("\n0,17.2868\n0.01,17.2868\n"));
  for (const std::string& field : ValueFields(csv)) ASSERT_THAT(field, MatchesRegex("-?[0-9]+(\\.[0-9]{1,4})?"));
}

TEST(RecordingCsv, PrintsZeroWithoutASign) {
  SimulationFlags flags;
  flags.resolution = 0.5;
  flags.noise = 1;
  const Simulation options = Options(flags);
  const std::string csv = RecordingCsv(options, Simulated(options), 1);
  EXPECT_THAT(csv, HasSubstr(",0\n"));
  EXPECT_THAT(csv, testing::Not(HasSubstr("-0\n")));
}

TEST(RecordingCsv, WritesTheEndsOfTheRangeAsGiven) {
  SimulationFlags flags;
  flags.range = "-9.9,12.1";
  const Simulation options = Options(flags);
  const std::vector<std::string> fields = ValueFields(RecordingCsv(options, Simulated(options), 1));
  EXPECT_THAT(fields, testing::Contains("12.1").Times(testing::Ge(50)));
  EXPECT_THAT(fields, testing::Contains("-9.9").Times(testing::Ge(50)));
}

TEST(RecordingCsv, PrintsShortTimesWithoutAnExponent) {
  SimulationFlags flags;
  flags.rate = 10000;
  const Simulation options = Options(flags);
  EXPECT_THAT(RecordingCsv(options, Simulated(options), 1), HasSubstr("\n0.0001,"));
}

TEST(TruthJson, ContainsParametersNoiseAndSeed) {
  SimulationFlags flags;
  flags.noise = 0.5;
  flags.resolution = 0.2;
  const std::string text = TruthJson(Options(flags), 7);
  const nlohmann::json truth = nlohmann::json::parse(text);
  EXPECT_EQ(truth.size(), 9);
  EXPECT_EQ(truth.at("inertia"), 0.04);
  EXPECT_EQ(truth.at("viscous"), 0);
  EXPECT_EQ(truth.at("coulomb"), 0.001);
  EXPECT_EQ(truth.at("release_angle"), 0.3);
  EXPECT_EQ(truth.at("release_time"), 0.5);
  EXPECT_EQ(truth.at("zero_angle"), 0);
  EXPECT_THAT(truth.at("sigma_rad").get<double>(), DoubleEq(0.5 * kRadPerDeg));
  EXPECT_THAT(truth.at("resolution_rad").get<double>(), DoubleEq(0.2 * kRadPerDeg));
  EXPECT_EQ(truth.at("seed"), 7);
  EXPECT_THAT(text, EndsWith("}\n"));
}

TEST(TruthJson, ContainsANoiseLawThatIsNotWhiteGaussian) {
  SimulationFlags flags;
  flags.noise = 0.5;
  flags.noise_correlation = 0.9;
  flags.noise_freedom = 4;
  const nlohmann::json truth = nlohmann::json::parse(TruthJson(Options(flags), 1));
  EXPECT_EQ(truth.at("noise_correlation"), 0.9);
  EXPECT_EQ(truth.at("noise_freedom"), 4);
}

TEST(TruthJson, ListsLostCounts) {
  SimulationFlags flags;
  EXPECT_FALSE(nlohmann::json::parse(TruthJson(Options(flags), 1)).contains("lost_counts"));
  flags.resolution = 0.5;
  flags.lose = "5.25:-3";
  const nlohmann::json truth = nlohmann::json::parse(TruthJson(Options(flags), 1));
  EXPECT_EQ(truth.at("lost_counts"), nlohmann::json::parse(R"([{"time_s": 5.25, "counts": -3}])"));
}

TEST(TruthJson, UsesRateNamesForARate) {
  SimulationFlags flags;
  flags.unit = "rad_s";
  flags.noise = 0.5;
  const nlohmann::json truth = nlohmann::json::parse(TruthJson(Options(flags), 1));
  EXPECT_EQ(truth.at("rate_bias"), 0);
  EXPECT_EQ(truth.at("sigma_rad_s"), 0.5);
  EXPECT_EQ(truth.at("resolution_rad_s"), 0);
  EXPECT_FALSE(truth.contains("sigma_rad"));
}

}  // namespace
}  // namespace pendulum::simulation_text_test
