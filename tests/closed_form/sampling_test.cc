// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/sampling.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::sampling_test {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kQ = 0.01;  // rad

/// A cosine of 1 rad that decays to 1/e in `decay` s, rounded to hundredths of a rad.
Recording Cosine(double frequency_hz, double rate_hz, Eigen::Index count, double decay = 1e9) {
  Recording recording;
  recording.time = Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)) / rate_hz;
  const Eigen::ArrayXd t = recording.time.array();
  recording.value = kQ * ((-t / decay).exp() * (2 * kPi * frequency_hz * t).cos() / kQ).round();
  recording.resolution = kQ;
  return recording;
}

auto Codes(const Sampling& sampling) {
  std::vector<std::string> codes;
  for (const Warning& warning : SamplingWarnings(sampling)) codes.emplace_back(warning.code.text());
  return codes;
}

std::string MessageOf(const Sampling& sampling, const std::string& code) {
  for (const Warning& warning : SamplingWarnings(sampling)) {
    if (warning.code == code) return MessageText(warning);
  }
  return "";
}

TEST(ApparentFrequency, FoldsAtHalfTheRate) {
  // Examples of the textbook: a cosine of 0.76 Hz sampled at 1 Hz has the samples of 0.24 Hz. Sampled once per cycle it
  // appears at rest. Sampled at 5/3 of its frequency it appears to swing at 2/3 of it.
  EXPECT_NEAR(ApparentFrequency(0.76, 1), 0.24, 1e-12);
  EXPECT_NEAR(ApparentFrequency(0.76, 0.76), 0, 1e-12);
  EXPECT_NEAR(ApparentFrequency(0.76, 0.76 * 5 / 3), 0.76 * 2 / 3, 1e-12);
  EXPECT_NEAR(ApparentFrequency(0.3, 1), 0.3, 1e-12);
  EXPECT_NEAR(ApparentFrequency(2.3, 1), 0.3, 1e-12);
}

TEST(ApparentFrequency, GivesTheSameSamplesAsTheTrueFrequency) {
  for (const double frequency : {0.1, 0.6, 1.3, 2.9}) {
    for (int i = 0; i < 9; ++i) {
      EXPECT_NEAR(std::cos(2 * kPi * frequency * i / 0.8),
                  std::cos(2 * kPi * ApparentFrequency(frequency, 0.8) * i / 0.8), 1e-12);
    }
  }
}

TEST(CanAliasWithinRange, IsTrueIfTwoFrequenciesGiveTheSameSamples) {
  EXPECT_FALSE(CanAliasWithinRange(0.66, 0.89, 1));      // the mirror frequencies 0.5 and 1 lie outside
  EXPECT_TRUE(CanAliasWithinRange(0.66, 0.89, 0.76));    // once per cycle
  EXPECT_TRUE(CanAliasWithinRange(0.66, 0.89, 1.52));    // twice per cycle
  EXPECT_FALSE(CanAliasWithinRange(0.66, 0.89, 1.267));  // 5/3 of 0.76
  EXPECT_FALSE(CanAliasWithinRange(0.66, 0.89, 100));    // 0 is no mirror between two positive frequencies
}

TEST(DescribeSampling, MeasuresAnEvenRecording) {
  const Sampling sampling = DescribeSampling(Cosine(0.5, 20, 400), 1.0, std::nullopt);
  EXPECT_NEAR(sampling.rate_hz, 20, 1e-9);
  EXPECT_NEAR(sampling.jitter, 0, 1e-12);
  EXPECT_EQ(sampling.gaps, 0);
  EXPECT_NEAR(sampling.samples_per_period, 40, 1e-9);
  EXPECT_NEAR(sampling.nyquist_margin, 20, 1e-9);
  EXPECT_EQ(sampling.start_counts, 200);
  EXPECT_EQ(sampling.end_counts, 200);
  EXPECT_EQ(sampling.saturated, 0);
  EXPECT_THAT(SamplingWarnings(sampling), IsEmpty());
}

TEST(DescribeSampling, CountsLevelsAtTheEnd) {
  const Sampling sampling = DescribeSampling(Cosine(0.5, 20, 400, 5), 1.0, std::nullopt);
  // The last period begins at 18 s. Its peak-to-peak value is less than 2 exp(-18/5) rad, which is 5.5 levels.
  EXPECT_EQ(sampling.start_counts, 100 + std::round(100 * std::exp(-1.0 / 5)));
  EXPECT_THAT(sampling.end_counts, DoubleNear(5, 1));
  EXPECT_THAT(Codes(sampling), IsEmpty());  // coming to rest causes no warning
}

TEST(DescribeSampling, WarnsOfFewLevelsAtTheStart) {
  Recording recording = Cosine(0.5, 20, 400);
  recording.resolution = 2.0 / 6;  // peak to peak is 2
  EXPECT_THAT(MessageOf(DescribeSampling(recording, 1.0, std::nullopt), "few_counts"),
              HasSubstr("spans only 6 levels"));
}

TEST(DescribeSampling, HasNoCountsWithoutAResolution) {
  Recording recording = Cosine(0.5, 20, 400);
  recording.resolution = 0;
  EXPECT_EQ(DescribeSampling(recording, 1.0, std::nullopt).start_counts, 0);
  EXPECT_THAT(Codes(DescribeSampling(recording, 1.0, std::nullopt)), IsEmpty());
}

TEST(DescribeSampling, CountsSaturatedReadings) {
  Recording recording = Cosine(0.5, 20, 41);
  recording.range = SensorRange{-2, 0.99};  // one period and its end: cos > 0.985 at samples 0, 1, 39 and 40
  recording.value = recording.value.cwiseMin(0.99);
  EXPECT_EQ(DescribeSampling(recording, 1.0, std::nullopt).saturated, 4);
}

TEST(DescribeSampling, FindsGapsAndJitter) {
  Recording recording = Cosine(0.5, 20, 400);
  recording.time.tail(300).array() += 1.45;
  for (Eigen::Index i = 0; i < 400; i += 3) recording.time[i] += 0.01;  // intervals of 40, 50 and 60 ms
  const Sampling sampling = DescribeSampling(recording, 1.0, std::nullopt);
  EXPECT_EQ(sampling.gaps, 1);
  EXPECT_NEAR(sampling.longest_gap, 1.49, 1e-9);  // before sample 100: 99 is late, 100 is not
  EXPECT_NEAR(sampling.jitter, 1.4826 * 0.01, 1e-9);
  EXPECT_THAT(Codes(sampling), ElementsAre("gaps", "jitter"));
}

TEST(SamplingWarnings, ReportFewerThanEightSamplesPerPeriod) {
  EXPECT_THAT(Codes(DescribeSampling(Cosine(0.5, 3.9, 60), 1.0, std::nullopt)), ElementsAre("slow_sampling"));
  EXPECT_THAT(Codes(DescribeSampling(Cosine(0.5, 4.1, 60), 1.0, std::nullopt)), IsEmpty());
  EXPECT_THAT(MessageOf(DescribeSampling(Cosine(0.5, 3.9, 60), 1.0, std::nullopt), "slow_sampling"),
              HasSubstr("sample at least at 10 Hz"));
}

TEST(SamplingWarnings, ExplainTheApparentPeriod) {
  // 0.76 Hz sampled at 1 Hz shows a period of 1 / 0.24 s = 4.17 s.
  const Sampling sampling = DescribeSampling(Cosine(0.76, 1, 30), 0.5 / 0.24, 0.76);
  EXPECT_NEAR(sampling.nyquist_margin, 0.5 / 0.76, 1e-12);
  EXPECT_NEAR(sampling.samples_per_period, 1 / 0.76, 1e-12);
  EXPECT_THAT(Codes(sampling), ElementsAre("aliased"));
  const std::string message = MessageOf(sampling, "aliased");
  EXPECT_THAT(message, HasSubstr("|0.76 - 1| = 0.24 Hz, a period of 4.17 s (4.17 s in the readings)"));
  EXPECT_THAT(message, HasSubstr("sample at least at 15.2 Hz"));
}

TEST(SamplingWarnings, ReportOneOrTwoSamplesPerCycleAsAmbiguous) {
  EXPECT_THAT(Codes(DescribeSampling(Cosine(0.76, 0.76, 30), std::nullopt, 0.76)), Contains("samples_near_period"));
  EXPECT_THAT(Codes(DescribeSampling(Cosine(0.76, 1.52, 30), std::nullopt, 0.76)), Contains("samples_near_period"));
  EXPECT_THAT(Codes(DescribeSampling(Cosine(0.76, 1.267, 30), std::nullopt, 0.76)),
              Not(Contains("samples_near_period")));
}

TEST(SamplingWarnings, ReportARateJustAboveTwiceTheFrequency) {
  EXPECT_THAT(Codes(DescribeSampling(Cosine(0.76, 1.7, 30), std::nullopt, 0.76)),
              ElementsAre("nearly_aliased", "samples_near_period"));
}

TEST(DescribeSampling, UsesTheRigsFrequencyOnlyIfTheSamplesAlias) {
  EXPECT_NEAR(DescribeSampling(Cosine(0.76, 100, 300), 0.5 / 0.76, 0.78).frequency_hz, 0.76, 1e-12);
  EXPECT_NEAR(DescribeSampling(Cosine(0.76, 1, 30), 0.5 / 0.24, 0.78).frequency_hz, 0.78, 1e-12);
}

}  // namespace
}  // namespace pendulum::sampling_test
