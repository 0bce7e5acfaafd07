// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor_defaults.h"

#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/sensor_statement.h"

namespace pendulum::sensor_defaults_test {
namespace {

using enum SensorEffect;

constexpr double kDegree = 0.017453292519943295;  // rad, NIST SP 811, table 6

/// 100 readings at 50 Hz that swing by `amplitude` about 0, and by half of it in the second half.
Recording Swinging(const std::string& unit, Quantity quantity, double amplitude = 0.4) {
  Recording recording;
  recording.unit = unit;
  recording.quantity = quantity;
  recording.time = Eigen::VectorXd::LinSpaced(100, 0, 1.98);
  recording.value = amplitude * (M_PI * Eigen::ArrayXd::LinSpaced(100, 0, 99)).cos();
  recording.value.tail(50) /= 2;
  return recording;
}

SensorErrors Assumed(const Recording& recording, const std::string& statement = "") {
  std::optional<SensorStatement> given;
  if (!statement.empty()) given = ParseSensorStatement(statement, "x", "given by --sensor").value();
  return SensorErrorsOf(recording, 0, 2, given);
}

enum class Times { kOnGrid, kMeasured };

/// A table with a header line and, above it, comments. Measured times are up to 2 units late.
Recording Read(const std::string& head, Times times = Times::kOnGrid) {
  constexpr int kRows = 40;
  std::string text = head;
  for (int i = 0; i < kRows; ++i) {
    const int late = times == Times::kMeasured ? i % 3 : 0;
    text += std::to_string(20 * i + late) + "," + std::to_string(500 + (i % 2 == 0 ? 200 : -200)) + "\n";
  }
  const Result<Recording> recording = ParseRecording(text, "run.csv");
  EXPECT_TRUE(recording) << recording.error().message();
  return recording.value_or(Recording());
}

// ---- The kind ------------------------------------------------------------------------------------------------------

TEST(SensorKindOf, FollowsUnitAndQuantity) {
  EXPECT_EQ(SensorKindOf(Swinging("counts", Quantity::kAngle)), "potentiometer");
  EXPECT_EQ(SensorKindOf(Swinging("volts", Quantity::kAngle)), "potentiometer");
  EXPECT_EQ(SensorKindOf(Swinging("volts", Quantity::kRate)), "gyro");
  EXPECT_EQ(SensorKindOf(Swinging("deg/s", Quantity::kRate)), "gyro");
  EXPECT_EQ(SensorKindOf(Swinging("m/s^2", Quantity::kAcceleration)), "accelerometer");
  EXPECT_EQ(SensorKindOf(Swinging("px", Quantity::kPosition)), "camera");
  EXPECT_EQ(SensorKindOf(Swinging("deg", Quantity::kAngle)), "angle sensor");
  Recording tracked = Swinging("m", Quantity::kAngle);
  tracked.arc = Arc{};
  EXPECT_EQ(SensorKindOf(tracked), "camera");
}

TEST(SensorKindOf, KnowsEncodersByTheirSteps) {
  const auto kind = [](const std::string& unit, double resolution) {
    Recording recording = Swinging(unit, Quantity::kAngle);
    recording.resolution = resolution;
    return SensorKindOf(recording);
  };
  EXPECT_EQ(kind("deg", 360.0 / 4096 * kDegree), "encoder");
  EXPECT_EQ(kind("rad", 2 * M_PI / 16384), "encoder");
  EXPECT_EQ(kind("deg", 0.15 * kDegree), "encoder");  // 600 lines in quadrature
  EXPECT_EQ(kind("deg", 0.25 * kDegree), "encoder");  // 360 lines in quadrature
  EXPECT_EQ(kind("deg", 0.1 * kDegree), "angle sensor");
  EXPECT_EQ(kind("deg", 0.01 * kDegree), "angle sensor");
  EXPECT_EQ(kind("rad", 0.001), "angle sensor");
  EXPECT_EQ(kind("deg", 270.0 / 1023 * kDegree), "angle sensor");  // a potentiometer, converted by the user
  EXPECT_EQ(kind("deg", 0), "angle sensor");
  Recording events = Swinging("counts", Quantity::kAngle);
  events.edge = 0.5;
  EXPECT_EQ(SensorKindOf(events), "encoder");
}

// ---- The defaults --------------------------------------------------------------------------------------------------

// The sizes are those of MODEL.md section 14.
TEST(SensorErrorsOf, AssumesThePublishedSizesOfAKind) {
  const Recording angle = Swinging("rad", Quantity::kAngle);
  const SensorErrors potentiometer = Assumed(angle, "potentiometer");
  EXPECT_EQ(potentiometer.kind, "potentiometer");
  EXPECT_DOUBLE_EQ(potentiometer.Of(kGain).std_dev, 0.01);
  EXPECT_DOUBLE_EQ(potentiometer.Of(kCubic).std_dev, 0.01 * 0.4);
  EXPECT_DOUBLE_EQ(potentiometer.Of(kEccentricSine).std_dev, 0.25 * kDegree);
  EXPECT_DOUBLE_EQ(potentiometer.Of(kEccentricCosine).std_dev, 0.25 * kDegree);
  EXPECT_DOUBLE_EQ(potentiometer.Of(kLag).std_dev, 0.012);
  EXPECT_DOUBLE_EQ(potentiometer.Of(kBacklash).std_dev, 0.05 * kDegree);
  EXPECT_DOUBLE_EQ(potentiometer.Of(kDrift).std_dev, 0.05 * kDegree);
  EXPECT_EQ(potentiometer.Of(kGain).SourceText(), "assumed for a potentiometer");
  const SensorErrors encoder = Assumed(angle, "encoder");
  EXPECT_EQ(encoder.Of(kGain).std_dev, 0);
  EXPECT_DOUBLE_EQ(encoder.Of(kEccentricSine).std_dev, 0.1 * kDegree);
  EXPECT_EQ(encoder.Of(kLag).SourceText(), "assumed for an encoder");
  const SensorErrors gyro = Assumed(Swinging("rad/s", Quantity::kRate));
  EXPECT_EQ(gyro.kind, "gyro");
  EXPECT_DOUBLE_EQ(gyro.Of(kGain).std_dev, 0.02);
  EXPECT_DOUBLE_EQ(gyro.Of(kLag).std_dev, 0.005);
  EXPECT_EQ(gyro.Of(kEccentricSine).std_dev, 0);
}

TEST(SensorErrorsOf, TakesTheAmplitudeOfTheSwing) {
  const Recording recording = Swinging("rad", Quantity::kAngle);
  EXPECT_DOUBLE_EQ(SensorErrorsOf(recording, 1.0, 1.98, std::nullopt).Of(kCubic).std_dev, 0.01 * 0.2);
}

TEST(SensorErrorsOf, TakesHalfAFrameForTheLagOfACamera) {
  EXPECT_DOUBLE_EQ(Assumed(Swinging("px", Quantity::kPosition)).Of(kLag).std_dev, 0.01);  // 50 Hz
}

TEST(SensorErrorsOf, HasNoAngleForReadingsWithoutACalibration) {
  const SensorErrors errors = Assumed(Swinging("counts", Quantity::kAngle, 200));
  for (const SensorEffect effect : {kGain, kEccentricSine, kEccentricCosine, kBacklash, kDrift}) {
    EXPECT_EQ(errors.Of(effect).std_dev, 0) << SensorEffectName(effect);
  }
  EXPECT_DOUBLE_EQ(errors.Of(kCubic).std_dev, 2);  // counts
}

TEST(SensorErrorsOf, HasNoErrorsOfAnIdealSensor) {
  const SensorErrors errors = Assumed(Read("# sample_rate_hz: 50\n# sensor: {\"kind\":\"ideal\"}\nindex,adc_counts\n"));
  EXPECT_EQ(errors.kind, "ideal");
  for (const EffectSize& size : errors.sizes) {
    EXPECT_EQ(size.std_dev, 0);
    EXPECT_EQ(size.source, "stated in the file");
  }
}

// ---- The clock -----------------------------------------------------------------------------------------------------

TEST(SensorErrorsOf, TakesTheClockFromTheSourceOfTheTimes) {
  const auto clock = [](const std::string& head) { return Assumed(Read(head, Times::kMeasured)).Of(kClock); };
  EXPECT_DOUBLE_EQ(clock("time_ms,adc_counts\n").std_dev, 0.003);
  EXPECT_EQ(clock("time_ms,adc_counts\n").SourceText(), "assumed for a ceramic resonator");
  EXPECT_DOUBLE_EQ(clock("time_us,angle_deg\n").std_dev, 0.003);
  EXPECT_DOUBLE_EQ(clock("time_s,adc_counts\n").std_dev, 0.003);
  EXPECT_DOUBLE_EQ(clock("time_s,angle_mrad\n").std_dev, 5e-5);
  EXPECT_DOUBLE_EQ(clock("time_s,x_px\n").std_dev, 1e-3);
  EXPECT_DOUBLE_EQ(clock("# sample_rate_hz: 50\nindex,adc_counts\n").std_dev, 0.03);
}

TEST(SensorErrorsOf, TrustsTimesOnAnExactGridLess) {
  for (const std::string head : {"time_ms,adc_counts\n", "time_s,angle_mrad\n"}) {
    const EffectSize clock = Assumed(Read(head, Times::kOnGrid)).Of(kClock);
    EXPECT_DOUBLE_EQ(clock.std_dev, 0.01);
    EXPECT_EQ(clock.SourceText(), "assumed for times on an exact grid");
  }
  EXPECT_DOUBLE_EQ(Assumed(Read("time_s,x_px\n", Times::kOnGrid)).Of(kClock).std_dev, 1e-3);  // frames
}

TEST(SensorErrorsOf, LeavesAStatedClockToItsOwnError) {
  for (const std::string line : {"# clock_scale: 1.002", "# clock_scale_std_dev: 0", "# clock_scale_std_dev: 1e-5"}) {
    const EffectSize clock = Assumed(Read(line + "\ntime_ms,adc_counts\n"), R"({"clock": 0.01})").Of(kClock);
    EXPECT_EQ(clock.std_dev, 0) << line;
    EXPECT_EQ(clock.source, "stated with the clock");
  }
}

// ---- What replaces the defaults
// --------------------------------------------------------------------------------------

constexpr const char* kCalibration =
    R"(# calibration: {"input": "counts", "angle_unit": "deg", "coefficients": [-100, 0.2])";

TEST(SensorErrorsOf, KeepsTheGainOfACalibrationWithoutErrors) {
  const SensorErrors errors = Assumed(Read(kCalibration + std::string("}\ntime_ms,adc_counts\n")));
  EXPECT_DOUBLE_EQ(errors.Of(kGain).std_dev, 0.01);
  EXPECT_NEAR(errors.Of(kCubic).std_dev, 0.01 * 40 * kDegree, 1e-12);
}

TEST(SensorErrorsOf, LeavesTheGainToTheErrorsOfACalibration) {
  const std::string covariance = ", \"covariance\": [[0.01, 0], [0, 1e-6]]";
  const SensorErrors errors = Assumed(Read(kCalibration + covariance + "}\ntime_ms,adc_counts\n"));
  EXPECT_EQ(errors.Of(kGain).std_dev, 0);
  EXPECT_EQ(errors.Of(kGain).SourceText(), "calibration");
  EXPECT_DOUBLE_EQ(errors.Of(kEccentricSine).std_dev, 0.25 * kDegree);
  const std::string residual = ", \"residual_std_dev\": 0.1";
  const SensorErrors limited = Assumed(Read(kCalibration + covariance + residual + "}\ntime_ms,adc_counts\n"));
  EXPECT_NEAR(limited.Of(kEccentricSine).std_dev, 0.1 * kDegree, 1e-15);
  EXPECT_NEAR(limited.Of(kCubic).std_dev, 0.1 * kDegree, 1e-15);
  EXPECT_EQ(limited.Of(kCubic).SourceText(), "calibration");
  EXPECT_DOUBLE_EQ(limited.Of(kBacklash).std_dev, 0.05 * kDegree);
}

TEST(SensorErrorsOf, PrefersWhatIsGivenToTheFileAndBothToTheDefaults) {
  const Recording recording =
      Read("# sensor: {\"kind\": \"encoder\", \"lag\": 0.002, \"gain\": 0.004}\ntime_ms,angle_mrad\n");
  const SensorErrors of_file = Assumed(recording);
  EXPECT_EQ(of_file.kind, "encoder");
  EXPECT_EQ(of_file.Of(kGain).std_dev, 0.004);
  EXPECT_EQ(of_file.Of(kGain).SourceText(), "stated in the file");
  EXPECT_EQ(of_file.Of(kBacklash).SourceText(), "assumed for an encoder");
  const SensorErrors given = Assumed(recording, R"({"gain": 0, "nonlinearity": 0.001})");
  EXPECT_EQ(given.kind, "angle sensor");
  EXPECT_EQ(given.Of(kGain).std_dev, 0);
  EXPECT_EQ(given.Of(kGain).SourceText(), "given by --sensor");
  EXPECT_EQ(given.Of(kEccentricCosine).std_dev, 0.001);
  EXPECT_EQ(given.Of(kLag).std_dev, 0.012);
  EXPECT_EQ(given.Of(kLag).SourceText(), "assumed for an angle sensor");
}

// ---- The line # sensor ---------------------------------------------------------------------------------------------

TEST(ReadRecording, TakesAnotherTextAfterSensorAsAComment) {
  const Recording recording = Read("# sensor: MPU-6050\n# sensor: soldered by Ada\ntime_ms,adc_counts\n");
  EXPECT_FALSE(recording.stated_sensor);
  ASSERT_EQ(recording.warnings.size(), 1U);
  EXPECT_EQ(recording.warnings[0].code, "sensor_unknown");
  EXPECT_NE(MessageText(recording.warnings[0]).find("# sensor: soldered by Ada names no kind"), std::string::npos);
}

TEST(ReadRecording, RefusesAWrongStatementWithItsLine) {
  const auto fault = [](const std::string& head) {
    const auto recording = ParseRecording(head + "time_ms,adc_counts\n0,1\n1,2\n", "run.csv");
    return recording ? "" : recording.error().message();
  };
  EXPECT_EQ(fault("# a\n# sensor: {\"gian\": 1}\n"),
            "run.csv:2: # sensor: \"gian\" is not a key of a sensor; the keys are kind, gain, nonlinearity, lag, "
            "backlash, drift, clock");
  EXPECT_NE(fault("# sensor: gyro\n# sensor: camera\n").find("is given twice"), std::string::npos);
}

}  // namespace
}  // namespace pendulum::sensor_defaults_test
