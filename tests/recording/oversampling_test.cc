// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/oversampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <tuple>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/recording.h"

namespace pendulum::oversampling_test {
namespace {

TEST(ParseAveragingWindow, ReadsALengthOrBothEnds) {
  const auto length = ParseAveragingWindow("0.004");
  ASSERT_TRUE(length);
  EXPECT_EQ(length->from, -0.002);
  EXPECT_EQ(length->to, 0.002);
  const auto ends = ParseAveragingWindow(" 0, 0.0018 ");
  ASSERT_TRUE(ends);
  EXPECT_EQ(ends->from, 0);
  EXPECT_EQ(ends->to, 0.0018);
  EXPECT_EQ(ends->middle(), 0.0009);
}

TEST(ParseAveragingWindow, RejectsOtherText) {
  for (const char* text :
       {"", "x", "nan", "inf", "-0.1", "1.1", "0.1,0.1", "0.2,0.1", "-1.5,0", "0,1.5", "0,1,2", "0,"})
    EXPECT_FALSE(ParseAveragingWindow(text)) << text;
}

/// Means of n rounded readings of a swing of 120 counts that decays, with noise of `sigma` counts, in steps of 1/n
/// count.
Eigen::VectorXd Means(int n, double sigma, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0, 1);
  Eigen::VectorXd value(2000);
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const double time = 0.01 * static_cast<double>(i);
    const double angle = 0.37 + 120 * std::exp(-0.03 * time) * std::cos(4.8 * time);
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += std::round(angle + sigma * noise(generator));
    value[i] = sum / n;
  }
  return value;
}

TEST(ReadingsPerMean, FindsHowManyReadingsAMeanHas) {
  for (const int n : {4, 8, 9, 10, 16, 24, 32, 48}) {
    for (const double sigma : {0.0, 0.05, 0.1, 0.25}) {
      SCOPED_TRACE("means of " + std::to_string(n) + ", noise of " + std::to_string(sigma));
      for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_EQ(ReadingsPerMean(Means(n, sigma, seed), 1.0 / n), n);
    }
  }
}

TEST(ReadingsPerMean, FindsNothingInSingleReadings) {
  for (const double sigma : {0.0, 0.05, 0.1, 0.25, 0.5, 2.0}) {
    SCOPED_TRACE(sigma);
    for (std::uint64_t seed = 1; seed <= 100; ++seed) EXPECT_EQ(ReadingsPerMean(Means(1, sigma, seed), 1), 1);
  }
  // With more noise rounding averages out, so that nothing depends on the number.
  EXPECT_EQ(ReadingsPerMean(Means(16, 0.6, 1), 1.0 / 16), 1);
  EXPECT_EQ(ReadingsPerMean(Eigen::VectorXd(), 1), 1);
  EXPECT_EQ(ReadingsPerMean(Eigen::VectorXd::Constant(500, 3), 0), 1);
}

std::string MeansFile(const std::string& head, const std::string& column, double scale) {
  const Eigen::VectorXd value = Means(4, 0.1, 1);
  std::string text = head + "time_s," + column + "\n";
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    text += std::to_string(0.01 * static_cast<double>(i)) + "," + std::to_string(scale * value[i]) + "\n";
  }
  return text;
}

bool Has(const Recording& recording, std::string_view code) {
  return std::ranges::any_of(recording.warnings, [&](const Warning& warning) { return warning.code == code; });
}

TEST(ReadRecording, AssumesMeansThatNobodyStated) {
  for (const auto& [head, column, scale] :
       {std::tuple("", "adc_counts", 1.0), std::tuple("# resolution: 0.2\n", "angle_deg", 0.2)}) {
    SCOPED_TRACE(std::string(head) + column);
    const auto recording = ParseRecording(MeansFile(head, column, scale), "run.csv");
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_TRUE(Has(*recording, "means_assumed"));
    EXPECT_EQ(recording->oversampling.readings, 4);
    EXPECT_NEAR(recording->oversampling.count / recording->resolution, 4, 1e-9);
    for (const Warning& warning : recording->warnings) EXPECT_NE(warning.code, "resolution_disagrees");
  }
}

TEST(ReadRecording, SaysThatRowsMayBeMeansIfTheCountIsUnknown) {
  const auto recording = ParseRecording(MeansFile("", "angle_deg", 0.2), "run.csv");
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_TRUE(Has(*recording, "means_possible"));
  EXPECT_EQ(recording->oversampling.readings, 1);
}

TEST(ReadRecording, TakesRowsForSingleReadingsIfAsked) {
  ReadOptions options;
  options.oversample = 1;
  const auto recording = ParseRecording(MeansFile("", "adc_counts", 1), "run.csv", options);
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_FALSE(Has(*recording, "means_assumed"));
  EXPECT_EQ(recording->oversampling.readings, 1);
  const auto stated = ParseRecording(MeansFile("# oversample: 4\n", "adc_counts", 1), "run.csv");
  ASSERT_TRUE(stated) << stated.error().message();
  EXPECT_FALSE(Has(*stated, "means_assumed"));
}

/// A swing of 30 counts read four times each, with readings that differ by one count now and then.
std::string File(const std::string& head, const std::string& column, double scale) {
  std::string text = head + "time_s," + column + "\n";
  for (int i = 0; i < 200; ++i) {
    const double mean = std::round(4 * (500 + 30 * std::sin(0.1 * i))) / 4;
    text += std::to_string(0.01 * i) + "," + std::to_string(scale * mean) + "\n";
  }
  return text;
}

TEST(FindCountLevels, KnowsWholeCounts) {
  for (const char* resolution : {"", "# resolution: 0.25\n", "# resolution: 1\n"}) {
    const auto recording =
        ParseRecording(File(std::string("# oversample: 4\n") + resolution, "adc_counts", 1), "run.csv");
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_EQ(recording->oversampling.readings, 4);
    EXPECT_EQ(recording->oversampling.count, 1);
    EXPECT_TRUE(recording->oversampling.is_level_known);
    EXPECT_EQ(recording->resolution, 0.25);
    EXPECT_EQ(CountOf(*recording), 1);
    for (const Warning& warning : recording->warnings) EXPECT_NE(warning.code, "resolution_disagrees");
  }
}

TEST(FindCountLevels, FindsTheGridOfAngles) {
  const auto recording = ParseRecording(File("# oversample: 4\n# resolution: 0.05\n", "angle_rad", 0.2), "run.csv");
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_NEAR(recording->oversampling.count, 0.2, 1e-12);
  EXPECT_FALSE(recording->oversampling.is_level_known);
  EXPECT_NEAR(std::remainder(recording->oversampling.level, 0.05), 0, 1e-6);
}

// Without noise nearly all means are whole counts, and seem to be the levels of the means.
TEST(FindCountLevels, SeesFewMeansBetweenCounts) {
  constexpr double kCount = 0.2;
  Recording recording;
  recording.value.resize(2000);
  for (Eigen::Index i = 0; i < recording.value.size(); ++i) {
    recording.value[i] = kCount * std::round(120 * std::sin(0.05 * static_cast<double>(i)));
    if (i % 50 == 0) recording.value[i] += kCount / 4;
  }
  recording.resolution = kCount;
  recording.oversampling.readings = 4;
  FindCountLevels(false, recording);
  EXPECT_NEAR(recording.oversampling.count, kCount, 1e-12);
  EXPECT_NEAR(recording.resolution, kCount / 4, 1e-12);
}

TEST(FindCountLevels, IsWithoutMeansTheResolution) {
  const auto recording = ParseRecording(File("# resolution: 0.25\n", "adc_counts", 1), "run.csv");
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_EQ(recording->oversampling.readings, 1);
  EXPECT_EQ(recording->oversampling.count, 0);
  EXPECT_EQ(CountOf(*recording), 0.25);
}

TEST(ReadRecording, MovesTimesToTheMiddleOfTheWindow) {
  const auto recording = ParseRecording(File("# oversample: 4\n# window_s: 0,0.008\n", "adc_counts", 1), "run.csv");
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_NEAR(recording->time[0], 0.004, 1e-12);
  ASSERT_TRUE(recording->oversampling.window);
  EXPECT_NEAR(recording->oversampling.window->from, -0.004, 1e-12);
}

TEST(ReadRecording, SaysThatAFlagContradictsTheFile) {
  ReadOptions options;
  options.oversample = 16;
  options.averaging_window = AveragingWindow{-0.001, 0.001};
  const auto recording = ParseRecording(
      File("# oversample: 4\n# window_s: 0.004\n# resolution: 0.25\n", "adc_counts", 1), "run.csv", options);
  ASSERT_TRUE(recording) << recording.error().message();
  EXPECT_EQ(recording->oversampling.readings, 16);
  int said = 0;
  for (const Warning& warning : recording->warnings) said += warning.code == "averaging_disagrees" ? 1 : 0;
  EXPECT_EQ(said, 2);
}

TEST(ReadRecording, RefusesImpossibleMeans) {
  for (const char* line : {"# oversample: 0\n", "# oversample: 65\n", "# oversample: 2.5\n", "# window_s: 2\n"}) {
    const auto recording = ParseRecording(File(line, "adc_counts", 1), "run.csv");
    ASSERT_FALSE(recording) << line;
    EXPECT_NE(recording.error().message().find("must be"), std::string::npos) << recording.error().message();
  }
}

}  // namespace
}  // namespace pendulum::oversampling_test
