// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/locate_turning_points.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/math/special_functions/ellint_1.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::locate_turning_points_test {
namespace {

using ::testing::HasSubstr;

constexpr double kFrequency = 4.8;          // rad/s
constexpr double kTurn = kPi / kFrequency;  // s

/// A small swing with turning points at 0.3 s + k kTurn, at 0.02 ± 0.4.
double Cosine(double t) { return 0.02 + 0.4 * std::cos(kFrequency * (t - 0.3)); }

/// A linear pendulum with dry friction alone, released at 0. Each half swing lasts kTurn, is centred at the point where
/// friction holds, and reduces the amplitude by 2 x_k.
double DryDecay(double t) {
  constexpr double kAmplitude = 0.4, kSticking = 0.01;
  const double k = std::floor(t / kTurn);
  const double side = std::fmod(k, 2) == 0 ? 1 : -1;
  return side * (kSticking + (kAmplitude - (2 * k + 1) * kSticking) * std::cos(kFrequency * t - kPi * k));
}

TEST(LocateTurningPoints, FindsACosinesTurningPointsExactly) {
  for (const double rate : {12.0, 20.0, 100.0, 1000.0}) {
    const TurningPointTable table = Must(LocateTurningPoints(Sample(Cosine, 10, rate)));
    ASSERT_GE(table.points.size(), 13U) << rate;
    for (const TurningPoint& point : table.points) {
      const double turns = (point.time - 0.3) / kTurn;
      EXPECT_NEAR(turns, std::round(turns), 2e-4) << rate;
      EXPECT_NEAR(std::abs(point.value - 0.02), 0.4, 2e-5) << rate;
    }
    EXPECT_NEAR(table.zero.value, 0.02, 1e-5) << rate;
    EXPECT_NEAR(table.half_period, kTurn, 2e-3 * kTurn) << rate;
  }
}

TEST(LocateTurningPoints, MatchesEllipticFunctionsForLargeSwings) {
  constexpr double kAmplitude = 1.5;
  const auto swing = [](double t) { return UndampedAngle(kAmplitude, 1 / (kFrequency * kFrequency), t - 0.5); };
  const TurningPointTable table = Must(LocateTurningPoints(Sample(swing, 10, 100)));
  const double turn = 2 / kFrequency * boost::math::ellint_1(std::sin(kAmplitude / 2));
  for (const TurningPoint& point : table.points) {
    const double turns = (point.time - 0.5) / turn;
    EXPECT_NEAR(turns, std::round(turns), 1e-6);
    EXPECT_NEAR(std::abs(point.value), kAmplitude, 2e-5);
  }
}

TEST(LocateTurningPoints, ScattersAsItsErrorsPredict) {
  const Recording clean = Sample(Cosine, 12, 100);
  double time_squares = 0, value_squares = 0, count = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const TurningPointTable table = Must(LocateTurningPoints(WithNoise(clean, 0.002, seed)));
    EXPECT_NEAR(table.noise, 0.002, 0.0002) << seed;
    for (const TurningPoint& point : table.points) {
      const double late = std::remainder(point.time - 0.3, kTurn);
      const double high = std::abs(point.value - 0.02) - 0.4;
      time_squares += late * late / point.covariance(0, 0);
      value_squares += high * high / point.covariance(1, 1);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(time_squares / count), 1, 0.08);  // 1000 turning points: 4 standard deviations
  EXPECT_NEAR(std::sqrt(value_squares / count), 1, 0.08);
}

TEST(LocateTurningPoints, AccountsForTheKinkOfDryFriction) {
  const Recording recording = Sample(DryDecay, 8, 200);
  const auto largest_delay = [&](const Kink& kink) {
    double largest = 0;
    for (const TurningPoint& point : Must(LocateTurningPoints(recording, kink)).points) {
      largest = std::max(largest, std::abs(std::remainder(point.time, kTurn)));
    }
    return largest;
  };
  EXPECT_LT(largest_delay({0.01, kFrequency}), 2e-5);
  EXPECT_GT(largest_delay({}), 1e-3);  // the error without the kink
  EXPECT_GT(largest_delay({-0.01, kFrequency}), 2e-3);
}

TEST(LocateTurningPoints, HasTheInfluencesOfTheReadings) {
  Recording recording = WithNoise(Sample(Cosine, 8, 100), 0.001, 7);
  const TurningPointTable before = Must(LocateTurningPoints(recording));
  const TurningPoint& point = before.points[2];
  const Eigen::Index sample = point.influence.cols() / 3;
  constexpr double kChange = 1e-5;
  recording.value[point.first + sample] += kChange;
  const TurningPoint after = Must(LocateTurningPoints(recording)).points[2];
  EXPECT_NEAR((after.time - point.time) / kChange, point.influence(0, sample),
              1e-3 * point.influence.row(0).maxCoeff());
  EXPECT_NEAR((after.value - point.value) / kChange, point.influence(1, sample), 1e-3);
  // A constant added to all readings changes the value by the same amount and the time not at all.
  EXPECT_NEAR(point.influence.row(0).sum(), 0, 1e-9);
  EXPECT_NEAR(point.influence.row(1).sum(), 1, 1e-9);
}

TEST(LocateTurningPoints, PropagatesInfluenceAndCovariance) {
  const TurningPointTable table = Must(LocateTurningPoints(WithNoise(Sample(Cosine, 8, 100), 0.001, 3)));
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(1, 2 * static_cast<Eigen::Index>(table.points.size()));
  gradient(0, 0) = -1;  // the time between the first and the last turning point
  gradient(0, gradient.cols() - 2) = 1;
  const double expected = table.points.front().covariance(0, 0) + table.points.back().covariance(0, 0);
  EXPECT_NEAR(CovarianceOf(table, gradient)(0, 0), expected, 1e-9 * expected);
  const Eigen::MatrixXd influence = InfluenceOf(table, gradient, 800);
  EXPECT_NEAR(influence.squaredNorm() * table.noise * table.noise, expected, 1e-9 * expected);
}

TEST(LocateTurningPoints, ExcludesSaturatedTurningPoints) {
  Recording recording = Sample(Cosine, 8, 100);
  recording.range = SensorRange{-1, 0.4};
  recording.value = recording.value.cwiseMin(0.4);
  EXPECT_FALSE(LocateTurningPoints(recording));  // the minima alone do not follow each other
  recording.range = SensorRange{-1, 0.5};
  recording.value = recording.value.cwiseMin(0.5);
  EXPECT_TRUE(LocateTurningPoints(recording));
}

TEST(LocateTurningPoints, ReportsWhereAGapBreaksTheSequence) {
  const TurningPointTable table = Must(LocateTurningPoints(WithoutSamples(Sample(Cosine, 12, 100), 4.0, 6.1)));
  int breaks = 0;
  for (std::size_t i = 1; i < table.points.size(); ++i) {
    const bool across = table.points[i - 1].time < 4.0 && table.points[i].time > 6.1;
    EXPECT_EQ(table.points[i].continues, !across) << i;
    breaks += across ? 1 : 0;
  }
  EXPECT_EQ(breaks, 1);
}

TEST(LocateTurningPoints, NeedsThreeConsecutiveTurningPoints) {
  const auto located = LocateTurningPoints(Sample(Cosine, 1.7, 100));
  ASSERT_FALSE(located);
  EXPECT_EQ(located.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(located.error().message(), HasSubstr("record for longer"));
}

}  // namespace
}  // namespace pendulum::locate_turning_points_test
