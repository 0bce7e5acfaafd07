// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/averaged_noise.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/swing/lost_counts.h"
#include "pendulum/trajectory/synthetic.h"

namespace pendulum::averaged_noise_test {
namespace {

constexpr double kCount = 0.0035;  // rad

/// 6 s at 100 Hz of a swing of 0.3 rad with means of readings; `noise` in counts.
SyntheticOptions Swing(int readings, double noise, double window) {
  SyntheticOptions options;
  options.parameters = {0.044, 0.0017, 0.002};
  options.release_angle = 0.3;
  options.release_time = 0.7;
  options.duration = 6;
  options.resolution = kCount;
  options.noise = noise * kCount;
  options.oversample = readings;
  options.averaging_window = window;
  options.seed = 11;
  return options;
}

FitReport FitOf(const Recording& recording) {
  FitOptions options;
  options.threads = 1;
  const Result<FitReport> fit = FitRecording(recording, options);
  EXPECT_TRUE(fit) << fit.error().message();
  return *fit;
}

/// The largest error of a parameter in standard errors.
double LargestError(const FitReport& fit, const SyntheticOptions& options) {
  const std::vector<double> truth = TrueParameters(options);
  double largest = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    EXPECT_TRUE(parameter.std_error) << parameter.info.name;
    largest = std::max(largest, std::abs(parameter.estimate - truth[i]) / parameter.std_error.value_or(1e-9));
  }
  return largest;
}

TEST(FitRecording, DescribesMeansOfRoundedReadings) {
  for (const double noise : {0.1, 0.3}) {
    for (const double window : {0.0, 0.01}) {
      const SyntheticOptions options = Swing(4, noise, window);
      const FitReport fit = FitOf(SimulateRecording(options).value());
      EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
      EXPECT_EQ(fit.noise.family, NoiseFamily::kAveraged);
      EXPECT_NEAR(fit.noise.sigma / kCount, noise, 0.06);
      EXPECT_LT(LargestError(fit, options), 4) << "noise " << noise << ", window " << window;
      EXPECT_FALSE(MayHaveOffsetJump(fit));
    }
  }
}

TEST(FitRecording, DescribesMeansWithoutNoise) {
  const SyntheticOptions options = Swing(4, 0, 0.01);
  const FitReport fit = FitOf(SimulateRecording(options).value());
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_EQ(fit.noise.family, NoiseFamily::kAveraged);
  EXPECT_LT(LargestError(fit, options), 4);
}

TEST(FitRecording, TakesMeansOfNoisyReadingsForContinuous) {
  const FitReport fit = FitOf(SimulateRecording(Swing(4, 2, 0.001)).value());
  EXPECT_EQ(fit.noise.family, NoiseFamily::kGaussian);
}

/// A window that nobody states is found from the scatter, and so are the levels.
TEST(FitRecording, FindsWindowAndLevels) {
  const SyntheticOptions options = Swing(4, 0.1, 0.01);
  Recording recording = SimulateRecording(options).value();
  recording.oversampling.window.reset();
  recording.oversampling.is_level_known = false;
  recording.oversampling.level = 2 * kCount / 4;
  const FitReport fit = FitOf(recording);
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_LT(LargestError(fit, options), 4);
}

TEST(FitRecording, NeedsMeansForAveragedNoise) {
  SyntheticOptions options = Swing(4, 0.1, 0);
  options.oversample = 1;
  FitOptions averaged;
  averaged.noise = NoiseFamily::kAveraged;
  const Result<FitReport> fit = FitRecording(SimulateRecording(options).value(), averaged);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message().find("--oversample"), std::string::npos) << fit.error().message();
}

}  // namespace
}  // namespace pendulum::averaged_noise_test
