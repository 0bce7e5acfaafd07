// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor_statement.h"

#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::sensor_statement_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string FaultOf(const std::string& text) {
  const Result<SensorStatement> statement = ParseSensorStatement(text, "sensor.json", "given");
  EXPECT_FALSE(statement.has_value()) << text;
  if (statement) return "";
  EXPECT_EQ(statement.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(statement.error().message(), StartsWith("sensor.json:"));
  return statement.error().message();
}

std::optional<double> StdDev(const SensorStatement& statement, SensorEffect effect) {
  return statement.std_devs[static_cast<std::size_t>(effect)];
}

TEST(ParseSensorStatement, TakesEachKindAsAWordOrInJson) {
  EXPECT_EQ(SensorKinds().size(), 7U);
  for (const std::string_view kind : SensorKinds()) {
    const std::string word(kind);
    const auto from_word = ParseSensorStatement(word, "x", "given");
    const auto from_json = ParseSensorStatement("{\"kind\": \"" + word + "\"}", "x", "given");
    ASSERT_TRUE(from_word && from_json) << kind;
    EXPECT_EQ(from_word->kind, kind);
    EXPECT_EQ(from_json->kind, kind);
    EXPECT_EQ(from_word->source, "given");
    for (const SensorEffect effect : kSensorEffects) EXPECT_FALSE(StdDev(*from_json, effect));
  }
}

TEST(ParseSensorStatement, ReadsEveryKey) {
  const auto statement = ParseSensorStatement(
      R"({"schema_version": 1, "kind": "encoder", "gain": 0.003, "nonlinearity": 0.002, "lag": 0.01, "backlash": 0,
          "drift": 10, "clock": 5e-5})",
      "sensor.json", "given by --sensor");
  ASSERT_TRUE(statement) << statement.error().message();
  EXPECT_EQ(statement->kind, "encoder");
  EXPECT_EQ(statement->source, "given by --sensor");
  EXPECT_EQ(StdDev(*statement, SensorEffect::kGain), 0.003);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kCubic), 0.002);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kEccentricSine), 0.002);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kEccentricCosine), 0.002);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kLag), 0.01);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kBacklash), 0.0);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kDrift), 10.0);
  EXPECT_EQ(StdDev(*statement, SensorEffect::kClock), 5e-5);
}

TEST(ParseSensorStatement, LeavesNullAndMissingKeysOpen) {
  const auto statement = ParseSensorStatement(R"({"gain": 0.01, "lag": null, "kind": null})", "sensor.json", "given");
  ASSERT_TRUE(statement) << statement.error().message();
  EXPECT_TRUE(statement->kind.empty());
  EXPECT_EQ(StdDev(*statement, SensorEffect::kGain), 0.01);
  EXPECT_FALSE(StdDev(*statement, SensorEffect::kLag));
  EXPECT_FALSE(StdDev(*statement, SensorEffect::kClock));
}

TEST(ParseSensorStatement, RefusesWhatItCannotUse) {
  EXPECT_EQ(FaultOf("sonar"),
            "sensor.json: \"sonar\" is not a kind of sensor; it must be one of potentiometer, encoder, gyro, "
            "accelerometer, camera, angle sensor, ideal, or a JSON object such as {\"kind\": \"potentiometer\", "
            "\"gain\": 0.003}");
  EXPECT_EQ(FaultOf(R"({"gian": 0.01})"),
            "sensor.json: \"gian\" is not a key of a sensor; the keys are kind, gain, nonlinearity, lag, backlash, "
            "drift, clock");
  EXPECT_THAT(FaultOf(R"({"kind": "sonar"})"), HasSubstr("\"kind\" is \"sonar\"; it must be one of potentiometer, "));
  EXPECT_THAT(FaultOf(R"({"kind": 3})"), HasSubstr("\"kind\" is 3; it must be one of"));
  EXPECT_THAT(FaultOf(R"({"schema_version": 2, "gain": 0})"), HasSubstr("\"schema_version\" is 2; it must be 1"));
  EXPECT_THAT(FaultOf("{}"), HasSubstr("the sensor states nothing; give at least one of kind, gain, "));
  EXPECT_THAT(FaultOf(R"({"gain": null})"), HasSubstr("states nothing"));
}

TEST(ParseSensorStatement, RefusesSizesThatAreNoStandardDeviations) {
  for (const std::string size : {"-0.001", "10.001", "1e300", "\"1 %\"", "true", "[0.01]", "{\"value\": 0.01}"}) {
    EXPECT_THAT(FaultOf("{\"gain\": " + size + "}"),
                HasSubstr("; it must be a standard deviation, a number from 0 (exact) to 10 in SI units"))
        << size;
  }
}

TEST(ParseSensorStatement, NamesThePlaceOfAnErrorInJson) {
  EXPECT_THAT(FaultOf("{\"gain\": 0.01,}"), HasSubstr("sensor.json:1:"));
  EXPECT_THAT(FaultOf(R"({"gain": 0.01, "gain": 0.02})"), HasSubstr("gain"));
}

}  // namespace
}  // namespace pendulum::sensor_statement_test
