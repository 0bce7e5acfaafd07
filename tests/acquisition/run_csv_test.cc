// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/run_csv.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/recording/readers/read_recording.h"

namespace pendulum::run_csv_test {
namespace {

namespace wire = pendulum_logger;

using testing::AllOf;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

constexpr SamplingRate kRate{10000, 1};  // 200 Hz

RunDescription Description() {
  RunDescription description;
  description.logger.firmware = 0x0100;
  description.logger.board = wire::kUno;
  description.logger.reference = 1;
  description.run = 17;
  description.begun = "2024-05-06T07:08:09Z";
  description.losses.emplace().is_end_known = true;
  return description;
}

/// `samples` samples of a sawtooth that starts at 500 and rises in steps of one count.
ReceivedRun Sawtooth(const SamplingRate& rate = kRate, int samples = 20) {
  ReceivedRun run(rate);
  for (int i = 0; i < samples; ++i) {
    wire::Data frame{};
    frame.tick = static_cast<std::uint32_t>(i * rate.Ticks());
    frame.count = 1;
    frame.sums[0] = static_cast<std::uint16_t>(rate.oversample * 500 + i % 7);
    EXPECT_TRUE(run.AddFrame(frame, 0));
  }
  return run;
}

std::string Text(const RunDescription& description, const ReceivedRun& run) {
  std::string text = RunHead(description, run.rate());
  for (std::size_t i = 0; i < run.size(); ++i) text += RunRow(run, i);
  return text;
}

/// The text as ReadRecording reads it.
Recording ReadBack(const RunDescription& description, const ReceivedRun& run = Sawtooth()) {
  const auto recording = ParseRecording(Text(description, run), "run.csv");
  EXPECT_TRUE(recording) << recording.error().message();
  return recording.value_or(Recording());
}

Calibration Line(double offset_deg, double deg_per_count) {
  Calibration calibration;
  calibration.input = "counts";
  calibration.angle_unit = "deg";
  calibration.coefficients = {offset_deg, deg_per_count};
  return calibration;
}

// ---- The file ----------------------------------------------------------------------------------------------------

// The metadata are those that read_recording.h documents; everything else is a comment.
TEST(RunHead, DescribesLoggerRunAndSensor) {
  const std::string head = RunHead(Description(), kRate);
  for (const char* line : {"# sample_rate_hz: 200\n", "# resolution: 1\n", "# range: 0,1023\n", "# clock_scale: 1\n",
                           "# clock_scale_std_dev: 0.003\n", "# lost_samples: 0\n"}) {
    EXPECT_THAT(head, HasSubstr(line));
  }
  for (const char* word : {"version 1.0", "Arduino Uno", "supply voltage", "run 17", "2024-05-06T07:08:09Z"}) {
    EXPECT_THAT(head, HasSubstr(word));
  }
  EXPECT_THAT(head, EndsWith("\ntime_s,adc_counts\n"));
  EXPECT_THAT(head, Not(AnyOf(HasSubstr("calibration"), HasSubstr("mean of"), HasSubstr("did not arrive"))));
}

TEST(RunHead, ReportsUnusualConditions) {
  RunDescription description = Description();
  description.losses->is_end_known = false;
  description.losses->samples = 3;
  description.clock.is_measured = true;
  EXPECT_THAT(RunHead(description, {1250, 16}),
              AllOf(HasSubstr("# each row is the mean of 16 conversions\n"), HasSubstr("# sample_rate_hz: 100\n"),
                    HasSubstr("# oversample: 16\n# window_s: -0.005,0.005\n"),
                    HasSubstr("# the logger's message about the end of the run did not arrive\n"),
                    HasSubstr("# lost_samples: 3\n"), HasSubstr("# the clock was compared with the host's"),
                    EndsWith("\ntime_s,adc_counts\n")));
}

TEST(RunRow, IsTimeAndCounts) {
  const ReceivedRun run = Sawtooth();
  EXPECT_EQ(RunRow(run, 0), "0,500\n");
  EXPECT_EQ(RunRow(run, 3), "0.015,503\n");
  const ReceivedRun of_means = Sawtooth({1250, 16});
  EXPECT_EQ(RunRow(of_means, 1), "0.01,500.0625\n");
}

// ---- Read back ---------------------------------------------------------------------------------------------------

TEST(RunCsv, IsReadBackSampleForSample) {
  const Recording recording = ReadBack(Description());
  ASSERT_EQ(recording.size(), 20);
  EXPECT_EQ(recording.unit, "counts");
  EXPECT_FALSE(recording.is_calibrated());
  for (int i = 0; i < 20; ++i) {
    EXPECT_DOUBLE_EQ(recording.time[i], 0.005 * i);
    EXPECT_EQ(recording.value[i], 500 + i % 7);
  }
  EXPECT_TRUE(recording.warnings.empty()) << MessageText(recording.warnings.front());
}

TEST(RunCsv, ContainsResolutionAndRange) {
  const Recording recording = ReadBack(Description());
  EXPECT_EQ(recording.resolution, 1);
  EXPECT_EQ(recording.resolution_source, "file");
  ASSERT_TRUE(recording.range);
  EXPECT_EQ(recording.range->low, 0);
  EXPECT_EQ(recording.range->high, 1023);
  EXPECT_EQ(ReadBack(Description(), Sawtooth({1250, 16})).resolution, 1.0 / 16);
  EXPECT_EQ(ReadBack(Description(), Sawtooth({2500, 3})).resolution, 1.0 / 3);
}

TEST(RunCsv, ReportsTheClockWithoutApplyingIt) {
  RunDescription description = Description();
  description.clock = {.scale = 1.00123457, .std_dev = 1.2e-5, .is_measured = true};
  const Recording recording = ReadBack(description);
  EXPECT_DOUBLE_EQ(recording.clock_scale, 1.00123457);
  EXPECT_DOUBLE_EQ(recording.clock_scale_std_dev, 1.2e-5);
  EXPECT_DOUBLE_EQ(recording.time[19], 0.095);
}

TEST(RunCsv, ReportsAnUnknownClock) {
  const Recording recording = ReadBack(Description());
  EXPECT_EQ(recording.clock_scale, 1);
  EXPECT_EQ(recording.clock_scale_std_dev, 0.003);
}

// -135 deg + 0.25 deg per count: 500 counts are -10 deg.
TEST(RunCsv, ContainsTheCalibration) {
  RunDescription description = Description();
  description.calibration = Line(-135, 0.25);
  description.calibration->covariance.resize(2, 2);
  description.calibration->covariance << 0.04, -6e-5, -6e-5, 1.25e-7;
  const Recording recording = ReadBack(description);
  ASSERT_TRUE(recording.is_calibrated());
  EXPECT_EQ(recording.value_unit(), "rad");
  EXPECT_NEAR(recording.value[0], -10 * kRadFromDeg, 1e-15);
  EXPECT_NEAR(recording.value[1], -9.75 * kRadFromDeg, 1e-15);
  EXPECT_NEAR(recording.resolution, 0.25 * kRadFromDeg, 1e-15);
  ASSERT_TRUE(recording.calibration);
  EXPECT_EQ(recording.calibration->coefficients, description.calibration->coefficients);
  EXPECT_EQ(recording.calibration->covariance, description.calibration->covariance);
}

// With time stamps, lost samples leave a gap and do not shift later samples. Without time stamps, all times after the
// loss are wrong and the reader gets a warning.
TEST(RunCsv, ReportsLostSamples) {
  RunDescription description = Description();
  description.losses->samples = 4;
  EXPECT_TRUE(ReadBack(description).warnings.empty());
  std::string text = RunHead(description, kRate);
  text.replace(text.find("time_s,"), 7, "");
  for (int i = 0; i < 20; ++i) text += std::to_string(500 + i % 7) + "\n";
  const auto recording = ParseRecording(text, "run.csv");
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_DOUBLE_EQ(recording->time[19], 0.095);  // from # sample_rate_hz
  ASSERT_EQ(recording->warnings.size(), 1);
  EXPECT_EQ(recording->warnings[0].code, "lost_samples");
  EXPECT_THAT(MessageText(recording->warnings[0]), HasSubstr("4"));
}

TEST(RunCsv, KeepsTheTimesAfterAGap) {
  ReceivedRun run(kRate);
  for (const int i : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 14, 15, 16, 17, 18, 19, 20}) {
    wire::Data frame{};
    frame.tick = static_cast<std::uint32_t>(10000 * i);
    frame.count = 1;
    frame.sums[0] = static_cast<std::uint16_t>(500 + i);
    ASSERT_TRUE(run.AddFrame(frame, 0));
  }
  const Recording recording = ReadBack(Description(), run);
  ASSERT_EQ(recording.size(), 18);
  EXPECT_DOUBLE_EQ(recording.time[10], 0.065);
  EXPECT_DOUBLE_EQ(recording.time[17], 0.1);
}

// Time stamps are exact even after hours: at 1e4 s a double still resolves 0.5 us.
TEST(RunCsv, KeepsEveryTickOfALongRun) {
  ReceivedRun run({251, 1});
  wire::Data frame{};
  frame.count = 1;
  for (int i = 0; i < 20; ++i, frame.tick += 251 * 4000000U) ASSERT_TRUE(run.AddFrame(frame, 502 * i));
  const Recording recording = ReadBack(Description(), run);
  ASSERT_EQ(recording.size(), 20);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(recording.time[i], 502.0 * i);
}

// ---- Calibrations in an EEPROM -----------------------------------------------------------------------------------

wire::Info Stored(const wire::StraightLine& line) {
  wire::Info info{};
  info.has_calibration = 1;
  info.calibration = line;
  return info;
}

TEST(StoredCalibration, IsMissingIfNoneIsStored) {
  wire::Info info = Stored({-135, 0.25F, 0, 0, 0});
  info.has_calibration = 0;
  EXPECT_FALSE(StoredCalibration(info));
}

TEST(StoredCalibration, ConvertsCountsToDegrees) {
  const auto calibration = StoredCalibration(Stored({-135, 0.25F, 0, 0, 0}));
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->input, "counts");
  EXPECT_EQ(calibration->angle_unit, "deg");
  EXPECT_EQ(calibration->coefficients, (std::vector<double>{-135, 0.25}));
  EXPECT_EQ(calibration->covariance.size(), 0);
  ASSERT_TRUE(calibration->input_range);
  EXPECT_EQ(calibration->input_range->low, 0);
  EXPECT_EQ(calibration->input_range->high, 1023);
  EXPECT_NEAR(calibration->Angle(540), 0, 1e-15);
}

// The float nearest to 0.2637 is 0.263700008392333984375.
TEST(StoredCalibration, HasTheIntendedDigits) {
  const auto calibration = StoredCalibration(Stored({-135.1F, 0.2637F, 0.04F, -6e-5F, 1.25e-7F}));
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->coefficients, (std::vector<double>{-135.1, 0.2637}));
  ASSERT_EQ(calibration->covariance.rows(), 2);
  EXPECT_EQ(calibration->covariance(0, 0), 0.04);
  EXPECT_EQ(calibration->covariance(0, 1), -6e-5);
  EXPECT_EQ(calibration->covariance(1, 0), -6e-5);
  EXPECT_EQ(calibration->covariance(1, 1), 1.25e-7);
}

TEST(StoredCalibration, IsWrittenToAFileAndReadBack) {
  RunDescription description = Description();
  description.calibration = StoredCalibration(Stored({-135, 0.25F, 0.04F, -6e-5F, 1.25e-7F}));
  const Recording recording = ReadBack(description);
  ASSERT_TRUE(recording.calibration);
  EXPECT_EQ(recording.calibration->coefficients, (std::vector<double>{-135, 0.25}));
  EXPECT_NEAR(recording.value[0], -10 * kRadFromDeg, 1e-15);
  EXPECT_EQ(recording.resolution_source, "file");
}

TEST(StraightLineOf, KeepsDegrees) {
  const auto line = StraightLineOf(Line(-135.5, 0.2637));
  ASSERT_TRUE(line) << line.error().message();
  EXPECT_EQ(line->offset_deg, -135.5F);
  EXPECT_EQ(line->deg_per_count, 0.2637F);
  EXPECT_EQ(line->offset_variance, 0);
  EXPECT_EQ(line->covariance, 0);
  EXPECT_EQ(line->slope_variance, 0);
}

// pi/4 rad is 45 deg, and a variance of 1 rad^2 is (180/pi)^2 = 3282.806 deg^2.
TEST(StraightLineOf, ConvertsRadiansToDegrees) {
  Calibration calibration = Line(-kPi / 4, kPi / 720);
  calibration.angle_unit = "rad";
  calibration.covariance.resize(2, 2);
  calibration.covariance << 1, -0.001, -0.001, 2e-6;
  const auto line = StraightLineOf(calibration);
  ASSERT_TRUE(line) << line.error().message();
  EXPECT_FLOAT_EQ(line->offset_deg, -45);
  EXPECT_FLOAT_EQ(line->deg_per_count, 0.25);
  EXPECT_FLOAT_EQ(line->offset_variance, 3282.806F);
  EXPECT_FLOAT_EQ(line->covariance, -3.282806F);
  EXPECT_FLOAT_EQ(line->slope_variance, 2 * 0.003282806F);
}

TEST(StraightLineOf, IsReproducedExactly) {
  Calibration calibration = Line(-135.1, 0.2637);
  calibration.covariance.resize(2, 2);
  calibration.covariance << 0.0412, -6.01e-5, -6.01e-5, 1.25e-7;
  const auto line = StraightLineOf(calibration);
  ASSERT_TRUE(line) << line.error().message();
  const auto again = StoredCalibration(Stored(*line));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->coefficients, calibration.coefficients);
  EXPECT_EQ(again->covariance, calibration.covariance);
}

TEST(StraightLineOf, RefusesCalibrationsALoggerCannotStore) {
  Calibration of_volts = Line(-135, 54);
  of_volts.input = "volts";
  Calibration curve = Line(-135, 0.25);
  curve.coefficients.push_back(1e-6);
  for (const Calibration& calibration : {of_volts, curve}) {
    const auto line = StraightLineOf(calibration);
    ASSERT_FALSE(line);
    EXPECT_EQ(line.error().code, StatusCode::kInvalidArgument);
  }
  EXPECT_THAT(StraightLineOf(of_volts).error().message(), HasSubstr("volts"));
  EXPECT_THAT(StraightLineOf(curve).error().message(), HasSubstr("curve"));
}

}  // namespace
}  // namespace pendulum::run_csv_test
