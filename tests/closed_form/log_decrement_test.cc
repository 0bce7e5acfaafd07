// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/log_decrement.h"

#include <cmath>
#include <vector>

#include <boost/math/special_functions/ellint_1.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/locate_turning_points.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::log_decrement_test {
namespace {

constexpr double kDampingRatio = 0.01;
constexpr double kNatural = 4.8;  // rad/s
const double kDamped = kNatural * std::sqrt(1 - kDampingRatio * kDampingRatio);

/// A linear pendulum with viscous friction, released at 0.5 s.
double Linear(double t) {
  const double since = t - 0.5;
  const double phase = kDamped * since;
  return 0.02 + 0.4 * std::exp(-kDampingRatio * kNatural * since) *
                    (std::cos(phase) + kDampingRatio * kNatural / kDamped * std::sin(phase));
}

TEST(LogDecrement, ReproducesTheLinearPendulum) {
  const TurningPointTable table = Must(LocateTurningPoints(Sample(Linear, 15, 100)));
  for (const int periods : {1, 2, 5, 9}) {
    const auto found = ApplyLogDecrement(table, Gravity::kLinear, 1, periods);
    ASSERT_TRUE(found) << periods;
    EXPECT_EQ(found->periods, periods);
    EXPECT_NEAR(found->damped_frequency.value / kDamped, 1, 1e-6) << periods;
    EXPECT_NEAR(found->log_decrement.value, 2 * kPi * kDampingRatio * kNatural / kDamped, 1e-5) << periods;
    EXPECT_NEAR(found->damping_ratio.value, kDampingRatio, 2e-6) << periods;
    EXPECT_NEAR(found->natural_frequency.value / kNatural, 1, 1e-6) << periods;
    EXPECT_NEAR(found->inertia.value * kNatural * kNatural, 1, 2e-6) << periods;
    EXPECT_NEAR(found->viscous.value, 2 * kDampingRatio / kNatural, 1e-6) << periods;
    EXPECT_DOUBLE_EQ(found->corrected_inertia.value, found->inertia.value);  // linear gravity needs no correction
  }
}

TEST(LogDecrement, ScattersAsItsErrorsPredict) {
  const Recording clean = Sample(Linear, 15, 100);
  constexpr int kSeeds = 200;
  Eigen::Array4d squares = Eigen::Array4d::Zero();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const TurningPointTable table = Must(LocateTurningPoints(WithNoise(clean, 1e-3, seed)));
    const auto found = ApplyLogDecrement(table, Gravity::kLinear, 0, 5);
    ASSERT_TRUE(found);
    const auto square = [](const Estimate& estimate, double truth) {
      return std::pow((estimate.value - truth) / estimate.std_error, 2);
    };
    squares += Eigen::Array4d(square(found->damped_frequency, kDamped), square(found->damping_ratio, kDampingRatio),
                              square(found->inertia, 1 / (kNatural * kNatural)),
                              square(found->viscous, 2 * kDampingRatio / kNatural)) /
               kSeeds;
  }
  for (const double mean_square : squares) EXPECT_NEAR(std::sqrt(mean_square), 1, 0.2);  // 4 standard deviations
}

TEST(LogDecrement, AttributesTheLongerPeriodOfLargeSwingsToInertia) {
  constexpr double kAmplitude = 0.8;  // rad
  const auto swing = [](double t) { return UndampedAngle(kAmplitude, 1 / (kNatural * kNatural), t); };
  const TurningPointTable table = Must(LocateTurningPoints(Sample(swing, 15, 100)));
  const auto found = ApplyLogDecrement(table, Gravity::kSine, 0, 5);
  ASSERT_TRUE(found);
  const double ratio = 2 / kPi * boost::math::ellint_1(std::sin(kAmplitude / 2));
  EXPECT_NEAR(found->inertia.value * kNatural * kNatural, ratio * ratio, 1e-5);
  EXPECT_NEAR(found->corrected_inertia.value * kNatural * kNatural, 1, 1e-5);
}

TEST(LogDecrement, ChoosesThePeriodsWithTheSmallestError) {
  const TurningPointTable table = Must(LocateTurningPoints(WithNoise(Sample(Linear, 25, 100), 1e-3, 4)));
  const auto best = ApplyLogDecrement(table, Gravity::kLinear);
  ASSERT_TRUE(best);
  EXPECT_EQ(best->first, 0U);
  for (int n = 1; ApplyLogDecrement(table, Gravity::kLinear, 0, n); ++n) {
    const auto other = ApplyLogDecrement(table, Gravity::kLinear, 0, n);
    EXPECT_GE(other->damping_ratio.std_error, 0.99 * best->damping_ratio.std_error) << n;
  }
}

TEST(LogDecrement, HasTheGradientOfItsTurningPoints) {
  TurningPointTable table = Must(LocateTurningPoints(WithNoise(Sample(Linear, 15, 100), 1e-3, 4)));
  const auto before = ApplyLogDecrement(table, Gravity::kSine, 0, 4);
  constexpr double kChange = 1e-5;
  table.points[8].value += kChange;
  table.zero.value = 0;  // computed again from the values
  const Eigen::VectorXd weights = table.ZeroWeights();
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    table.zero.value += weights[i] * table.points[static_cast<std::size_t>(i)].value;
  }
  const auto after = ApplyLogDecrement(table, Gravity::kSine, 0, 4);
  ASSERT_TRUE(before && after);
  const Eigen::Vector4d slope = before->gradient.col(17);
  EXPECT_NEAR((after->damping_ratio.value - before->damping_ratio.value) / kChange, slope[0],
              1e-3 * std::abs(slope[0]));
  EXPECT_NEAR((after->viscous.value - before->viscous.value) / kChange, slope[2], 1e-3 * std::abs(slope[2]));
  const double corrected = (after->corrected_inertia.value - before->corrected_inertia.value) / kChange;
  EXPECT_NEAR(corrected, slope[3], 1e-2 * std::abs(slope[3]));
}

TEST(LogDecrement, IsMissingBeyondTheTurningPointsOrAcrossAGap) {
  const TurningPointTable table = Must(LocateTurningPoints(WithoutSamples(Sample(Linear, 15, 100), 5.0, 7.0)));
  EXPECT_FALSE(ApplyLogDecrement(table, Gravity::kSine, 0, 40));
  EXPECT_FALSE(ApplyLogDecrement(table, Gravity::kSine, 0, 0));
  EXPECT_TRUE(ApplyLogDecrement(table, Gravity::kSine, 0, 2));
  EXPECT_FALSE(ApplyLogDecrement(table, Gravity::kSine, 0, 4));
  const auto longest = ApplyLogDecrement(table, Gravity::kSine);
  ASSERT_TRUE(longest);
  EXPECT_GT(table.points[longest->first].time, 7.0);
}

TEST(TabulateDecay, GivesEachPairAndTheSumSoFar) {
  const TurningPointTable table = Must(LocateTurningPoints(Sample(Linear, 15, 100)));
  const std::vector<DecayRow> rows = TabulateDecay(table);
  ASSERT_EQ(rows.size(), table.points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].point, i);
    EXPECT_EQ(rows[i].periods, static_cast<int>(i / 2));
    EXPECT_EQ(rows[i].pair.has_value(), i + 2 < rows.size());
    EXPECT_EQ(rows[i].so_far.has_value(), i >= 2);
    EXPECT_NEAR(rows[i].pair.value_or(Estimate{kDampingRatio}).value, kDampingRatio, 2e-5) << i;
    EXPECT_NEAR(rows[i].so_far.value_or(Estimate{kDampingRatio}).value, kDampingRatio, 2e-5) << i;
  }
}

}  // namespace
}  // namespace pendulum::log_decrement_test
