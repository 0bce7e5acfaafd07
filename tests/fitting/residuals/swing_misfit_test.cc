// SPDX-License-Identifier: Apache-2.0
// Noise of any colour is no misfit; residuals that repeat with the swing, or belong to one part of it, are one.
// Readings are those of a damped oscillation, residuals are simulated.
#include "pendulum/fitting/residuals/swing_misfit.h"

#include <cmath>
#include <cstdint>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/fitting/correlated_noise.h"

namespace pendulum::swing_misfit_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kPeriod = 1.31;  // s
constexpr Index kSamples = 2000;  // of 0.01 s: 15 periods

VectorXd Phase() { return 2 * kPi / kPeriod * EvenTimes(kSamples); }

VectorXd Swing() { return (-EvenTimes(kSamples) / 25).array().exp() * Phase().array().cos(); }

double SquaredInflation(double phi) { return (1 + phi * phi) / (1 - phi * phi); }

bool IsMisfit(const VectorXd& z, double phi) {
  return IsSwingMisfit(EvenTimes(kSamples), Swing(), z, SquaredInflation(phi));
}

TEST(IsSwingMisfit, TakesNoiseOfAnyColourForNoise) {
  constexpr int kSeeds = 500;
  for (const double phi : {0.0, 0.5, 0.9, 0.98}) {
    int alarms = 0;
    for (int seed = 1; seed <= kSeeds; ++seed)
      alarms += IsMisfit(FirstOrderNoise(kSamples, phi, 0, static_cast<std::uint64_t>(seed)), phi) ? 1 : 0;
    EXPECT_LE(alarms, 5) << phi;  // of 500 at a rate of 0.002, more than 5 happen once in 1700 times
  }
}

/// The share of 50 recordings in which a misfit is seen in noise of a standard deviation of 1.
double ShareSeen(const VectorXd& misfit, double phi) {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    seen += IsMisfit(misfit + FirstOrderNoise(kSamples, phi, 0, seed), phi) ? 1 : 0;
  return seen / 50.0;
}

TEST(IsSwingMisfit, SeesWhatRepeatsWithTheSwing) {
  const VectorXd phase = Phase();
  const VectorXd slowly = (kPi * EvenTimes(kSamples) / 20).array().cos();
  const VectorXd of_amplitude = slowly.cwiseProduct(VectorXd(phase.array().cos()));  // as friction of another law
  const VectorXd of_curve = (3 * phase).array().cos();                               // as a sensor's nonlinearity
  for (const double phi : {0.0, 0.5, 0.9}) {
    const double size = 1.2 * std::sqrt((1 + phi) / (1 - phi));  // times the noise at low frequencies
    EXPECT_GT(ShareSeen(size * of_amplitude, phi), 0.9) << phi;
    EXPECT_GT(ShareSeen(size * of_curve, phi), 0.9) << phi;
  }
}

TEST(IsSwingMisfit, SeesATouchInOnePeriod) {
  VectorXd touch = VectorXd::Zero(kSamples);
  touch.segment(1700, 100).setConstant(4);
  EXPECT_GT(ShareSeen(touch, 0.5), 0.9);
}

// The fewest periods that are judged.
TEST(IsSwingMisfit, SeesAMisfitOfNinePeriods) {
  const VectorXd phase = 2 * kPi / 1.95 * EvenTimes(kSamples);
  const VectorXd swing = (-EvenTimes(kSamples) / 25).array().exp() * phase.array().cos();
  const VectorXd misfit =
      3 * (kPi * EvenTimes(kSamples) / 20).array().cos() * phase.array().cos();  // as friction of another law
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const VectorXd noise = FirstOrderNoise(kSamples, 0.5, 0, seed);
    EXPECT_FALSE(IsSwingMisfit(EvenTimes(kSamples), swing, noise, SquaredInflation(0.5))) << seed;
    seen += IsSwingMisfit(EvenTimes(kSamples), swing, misfit + noise, std::nullopt) ? 1 : 0;
  }
  EXPECT_GT(seen, 45);
}

TEST(IsSwingMisfit, SeesARestBesideTheTrajectory) {
  VectorXd swing = Swing();
  swing.tail(600).setConstant(swing[1400]);
  VectorXd beside = VectorXd::Zero(kSamples);
  beside.tail(550).setConstant(2);
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const VectorXd noise = FirstOrderNoise(kSamples, 0.5, 0, seed);
    seen += IsSwingMisfit(EvenTimes(kSamples), swing, beside + noise, SquaredInflation(0.5)) ? 1 : 0;
  }
  EXPECT_GT(seen, 45);
}

TEST(IsSwingMisfit, CannotTellFromFewPeriodsOrSamples) {
  const VectorXd noise = FirstOrderNoise(kSamples, 0.5, 0, 1);
  ASSERT_FALSE(IsMisfit(noise, 0.5));
  const auto with_period = [&](double period) {
    const VectorXd swing = (2 * kPi / period * EvenTimes(kSamples)).array().cos();
    return IsSwingMisfit(EvenTimes(kSamples), swing, noise, SquaredInflation(0.5));
  };
  EXPECT_FALSE(with_period(1.0));
  EXPECT_TRUE(with_period(4.0));    // five periods
  EXPECT_TRUE(with_period(0.055));  // six samples in each
}

}  // namespace
}  // namespace pendulum::swing_misfit_test
