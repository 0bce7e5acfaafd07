// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/rest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace pendulum::rest_test {
namespace {

constexpr double kRadPerSecond = 2 * std::numbers::pi / 1.5;  // of swings with a period of 1.5 s
constexpr double kMiddle = 512.3;                             // counts

/// A reading as a function of time [s], in counts, before noise and rounding.
using Motion = std::function<double(double time)>;

/// How a logger samples the motion.
struct Reading {
  double rate_hz = 200;
  double noise = 0.3;  // standard deviation, counts
  std::uint32_t seed = 1;
};

/// The first time at which rest is detected within `seconds`.
std::optional<double> RestOf(const Motion& motion, double seconds, const Reading& reading = {}) {
  std::mt19937 random(reading.seed);
  std::normal_distribution<double> noise(0, reading.noise > 0 ? reading.noise : 1);
  RestDetector detector;
  for (int i = 0; i < seconds * reading.rate_hz; ++i) {
    const double time = i / reading.rate_hz;
    detector.AddSample(time, std::round(motion(time) + (reading.noise > 0 ? noise(random) : 0)));
    if (detector.IsAtRest()) return time;
  }
  return std::nullopt;
}

/// A swing with viscous friction: its amplitude falls by 1/e in tau.
Motion Decaying(double amplitude, double tau) {
  return [=](double time) { return kMiddle + amplitude * std::exp(-time / tau) * std::cos(kRadPerSecond * time); };
}

/// A swing with dry friction. Each half swing is centred at an angle `band` towards the side where it starts. The
/// pendulum rests at the first turning point within the band.
Motion DryFriction(double amplitude, double band) {
  return [=](double time) {
    const double half = std::numbers::pi / kRadPerSecond;
    double turn = amplitude;
    while (time > half && std::abs(turn) > band) {
      turn = -(turn - std::copysign(2 * band, turn));
      time -= half;
    }
    if (std::abs(turn) <= band) return kMiddle + turn;
    const double centre = std::copysign(band, turn);
    return kMiddle + centre + (turn - centre) * std::cos(kRadPerSecond * time);
  };
}

/// A pendulum that is held at one angle and released at the time `release`.
Motion HeldUntil(double release, const Motion& swing) {
  return [=](double time) { return swing(std::max(0.0, time - release)); };
}

/// The time at which the amplitude of Decaying has fallen to `counts`.
double WhenAmplitudeIs(double counts, double amplitude, double tau) { return tau * std::log(amplitude / counts); }

// ---- Rest is detected --------------------------------------------------------------------------------------------

// An amplitude of half a count is within rounding. Detection takes five seconds more.
TEST(RestDetector, DetectsTheRestOfADecayingSwing) {
  for (const double noise : {0.0, 0.3, 0.5, 1.0, 2.0}) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      const auto rest = RestOf(Decaying(300, 6), 120, {200, noise, seed});
      ASSERT_TRUE(rest) << noise;
      EXPECT_LT(*rest, WhenAmplitudeIs(0.5, 300, 6) + RestDetector::kRestSeconds + 3) << noise;
    }
  }
}

TEST(RestDetector, DetectsRestAfterDryFriction) {
  for (const double amplitude : {195.0, 205.0, 210.0, 215.0}) {  // it stops at different places within the band
    const auto rest = RestOf(DryFriction(amplitude, 10), 60);
    ASSERT_TRUE(rest) << amplitude;
    const double stop = 0.75 * std::ceil((amplitude - 10) / 20);  // half swings of 0.75 s, each 20 counts smaller
    EXPECT_GT(*rest, stop + RestDetector::kRestSeconds - 1) << amplitude;
    EXPECT_LT(*rest, stop + RestDetector::kRestSeconds + 3) << amplitude;
  }
}

TEST(RestDetector, DetectsRestAtOtherRates) {
  for (const double rate : {50.0, 100.0, 1000.0, 3700.0}) {
    const auto rest = RestOf(Decaying(300, 6), 120, {rate, 0.5, 5});
    ASSERT_TRUE(rest) << rate;
    EXPECT_LT(*rest, WhenAmplitudeIs(0.5, 300, 6) + RestDetector::kRestSeconds + 3) << rate;
  }
}

TEST(RestDetector, DetectsRestAfterAGapInTheSamples) {
  RestDetector detector;
  const Motion swing = Decaying(300, 3);
  for (int i = 0; i < 200 * 60; ++i) {
    const double time = i / 200.0;
    if (time < 4 || time > 4.8) detector.AddSample(time, std::round(swing(time)));
  }
  EXPECT_TRUE(detector.IsAtRest());
}

TEST(RestDetector, ReportsThatThePendulumHasSwung) {
  RestDetector detector;
  const Motion swing = Decaying(300, 60);
  EXPECT_FALSE(detector.HasSwung());
  for (int i = 0; i < 200 * 10; ++i) detector.AddSample(i / 200.0, std::round(swing(i / 200.0)));
  EXPECT_TRUE(detector.HasSwung());
  EXPECT_FALSE(detector.IsAtRest());
}

TEST(RestDetector, ReportsNoRestAfterAnotherPush) {
  RestDetector detector;
  const Motion swing = Decaying(300, 3);
  for (int i = 0; i < 200 * 40; ++i) detector.AddSample(i / 200.0, std::round(swing(i / 200.0)));
  EXPECT_TRUE(detector.IsAtRest());
  for (int i = 200 * 40; i < 200 * 42; ++i) detector.AddSample(i / 200.0, std::round(swing(i / 200.0 - 40)));
  EXPECT_FALSE(detector.IsAtRest());
}

// ---- Rest is not detected too early ------------------------------------------------------------------------------

TEST(RestDetector, ReportsNoRestAboveAnAmplitudeOfTwoCounts) {
  for (const double noise : {0.0, 0.3, 0.5, 1.0, 2.0}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const auto rest = RestOf(Decaying(100, 40), WhenAmplitudeIs(2, 100, 40), {200, noise, seed});
      EXPECT_FALSE(rest) << "noise " << noise << ", rest at " << rest.value_or(0);
    }
  }
}

// Almost no friction: a minute with an amplitude of 2 counts after a larger swing.
TEST(RestDetector, ReportsNoRestDuringASmallSwing) {
  const Motion swing = [](double time) { return kMiddle + (time < 20 ? 100 : 2) * std::cos(kRadPerSecond * time); };
  for (const double noise : {0.0, 0.5, 2.0}) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const auto rest = RestOf(swing, 80, {200, noise, seed});
      EXPECT_FALSE(rest) << "noise " << noise << ", rest at " << rest.value_or(0);
    }
  }
}

TEST(RestDetector, ReportsNoRestDuringTheHoldBeforeTheRelease) {
  for (const double rate : {50.0, 200.0, 1000.0}) {
    for (const double noise : {0.0, 0.5, 2.0}) {
      const auto rest = RestOf(HeldUntil(20, Decaying(300, 60)), 40, {rate, noise, 3});
      EXPECT_FALSE(rest) << rate << " Hz, noise " << noise << ", rest at " << rest.value_or(0);
    }
  }
}

// At the slowest rate of a logger without oversampling, 32 Hz, a tenth of a second has three or four samples.
TEST(RestDetector, DoesNotTreatNoiseAsASwing) {
  for (const double rate : {32.0, 40.0}) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const auto rest = RestOf([](double) { return kMiddle; }, 60, {rate, 2, seed});
      EXPECT_FALSE(rest) << rate << " Hz, seed " << seed << ", rest at " << rest.value_or(0);
    }
  }
}

TEST(RestDetector, ReportsNoRestIfThePendulumNeverMoves) {
  EXPECT_FALSE(RestOf([](double) { return kMiddle; }, 120, {200, 0, 1}));
  EXPECT_FALSE(RestOf([](double) { return kMiddle; }, 120, {200, 2, 1}));
}

// A hand moves the pendulum to and fro, looking for the release angle, and holds it at that angle.
TEST(RestDetector, ReportsNoRestWhileAHandMovesThePendulum) {
  const Motion hand = [](double time) {
    const double there = std::clamp((time - 10) / 2, 0.0, 1.0), back = std::clamp((time - 20) / 3, 0.0, 1.0);
    return kMiddle + 280 * there - 60 * back;
  };
  for (const double noise : {0.0, 0.5, 2.0}) EXPECT_FALSE(RestOf(hand, 60, {200, noise, 9})) << noise;
}

// A hand stops the pendulum beyond its last turning point. The pendulum did not come to rest by itself.
TEST(RestDetector, ReportsNoRestIfASwingIsCaughtAndHeld) {
  const Motion caught = [](double time) { return time < 15.2 ? Decaying(100, 60)(time) : kMiddle + 200; };
  EXPECT_FALSE(RestOf(caught, 60));
}

TEST(RestDetector, ReportsRestAfterFiveSecondsWithoutMotion) {
  const auto rest = RestOf([](double time) { return time < 15 ? Decaying(300, 60)(time) : kMiddle; }, 60);
  ASSERT_TRUE(rest);
  EXPECT_GT(*rest, 15 + RestDetector::kRestSeconds - 0.3);
  EXPECT_LT(*rest, 15 + RestDetector::kRestSeconds + 0.5);
}

}  // namespace
}  // namespace pendulum::rest_test
