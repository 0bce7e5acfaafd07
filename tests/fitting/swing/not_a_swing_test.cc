// SPDX-License-Identifier: Apache-2.0
// Data without a free swing are refused, or fitted and reported as not a swing, but never reported as converged.
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::not_a_swing_test {
namespace {

using Noise = std::function<double()>;

/// 10 s at 100 Hz of the readings y(t, noise). Each call of noise() draws from the standard normal distribution.
Recording Made(const std::function<double(double, const Noise&)>& y, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> draw;
  const Noise noise = [&] { return draw(generator); };
  Recording recording;
  recording.time = Eigen::VectorXd::LinSpaced(1000, 0, 9.99);
  recording.value.resize(1000);
  for (Eigen::Index i = 0; i < 1000; ++i) recording.value[i] = y(recording.time[i], noise);
  return Must(MakeRecording(std::move(recording)));
}

/// For every model and a few seeds, expects a refusal because there is no swing, or exit code 1 with a reason.
///
/// Two models can be left out. The small-angle model leaves 14 % of the variance of a true swing of 40 deg unexplained,
/// as much as for some of these data. Dahl's bristles let a pendulum creep to any angle, as a random walk does: of
/// three walks one is fitted.
void ExpectNeverConverged(const std::function<Recording(std::uint64_t)>& make, bool with_all = true) {
  for (const MotionModel& model : MotionModels()) {
    if (!with_all && (model.gravity == Gravity::kLinear || model.friction == "dahl")) continue;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::string(model.name) + ", seed " + std::to_string(seed));
      const Result<FitReport> report = FitRecording(make(seed), ModelOptions(model.name));
      if (!report) {
        EXPECT_EQ(report.error().code, StatusCode::kFailedPrecondition);
        continue;
      }
      EXPECT_EQ(ExitCode(report->termination), 1) << report->statistics.rms_residual;
      EXPECT_FALSE(report->reason.empty());
      EXPECT_EQ(report->covariance.size(), 0);
    }
  }
}

TEST(NotASwing, RejectsARandomWalk) {
  ExpectNeverConverged(
      [](std::uint64_t seed) {
        double position = 0;
        return Made([&](double, const Noise& noise) { return position += 0.05 * noise(); }, seed);
      },
      false);
}

TEST(NotASwing, RejectsWhiteNoise) {
  ExpectNeverConverged(
      [](std::uint64_t seed) { return Made([](double, const Noise& noise) { return 0.1 * noise(); }, seed); });
}

TEST(NotASwing, RejectsASawtooth) {
  ExpectNeverConverged([](std::uint64_t seed) {
    const double phase = 0.37 * static_cast<double>(seed);
    return Made([&](double t, const Noise& noise) { return 0.5 * std::fmod(0.8 * t + phase, 1.0) + 0.01 * noise(); },
                seed);
  });
}

TEST(NotASwing, RejectsASquareWave) {
  ExpectNeverConverged(
      [](std::uint64_t seed) {
        const double phase = 0.37 * static_cast<double>(seed);
        return Made(
            [&](double t, const Noise& noise) {
              return (std::fmod(0.8 * t + phase, 1.0) < 0.5 ? 0.3 : -0.3) + 0.01 * noise();
            },
            seed);
      },
      false);
}

TEST(NotASwing, RejectsAFrequencySweep) {
  ExpectNeverConverged([](std::uint64_t seed) {
    return Made(
        [](double t, const Noise& noise) { return 0.3 * std::sin(2 * kPi * t * (0.5 + 0.05 * t)) + 0.01 * noise(); },
        seed);
  });
}

TEST(NotASwing, RejectsAGrowingAmplitude) {
  ExpectNeverConverged([](std::uint64_t seed) {
    return Made(
        [](double t, const Noise& noise) { return 0.02 * std::exp(0.3 * t) * std::sin(5 * t) + 0.002 * noise(); },
        seed);
  });
}

}  // namespace
}  // namespace pendulum::not_a_swing_test
