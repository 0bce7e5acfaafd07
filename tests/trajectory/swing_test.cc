// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/swing.h"

#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/trajectory/swing_expansion.h"
#include "tests/model/coefficients.h"

namespace pendulum::swing_test {
namespace {

using testing::DoubleNear;
using testing::Lt;

TEST(OrderForTolerance, FollowsTheFormulaWithinItsLimits) {
  EXPECT_EQ(OrderForTolerance(1e-10), 18);  // 1 + 0.72 · 23.03 = 17.6
  EXPECT_EQ(OrderForTolerance(1e-12), 21);  // 1 + 0.72 · 27.63 = 20.9
  EXPECT_EQ(OrderForTolerance(4e-15), 25);  // 1 + 0.72 · 33.15 = 24.9
  EXPECT_EQ(OrderForTolerance(1e-30), kMaxOrder);
  EXPECT_EQ(OrderForTolerance(0.1), 8);
}

TEST(EvaluateSeries, IsThePolynomialUpToTheGivenOrder) {
  const Series<double> series = Coefficients({1, 2, 3});
  EXPECT_EQ(EvaluateSeries(series, 2, 2.0), 17);
  EXPECT_EQ(EvaluateSeries(series, 1, 2.0), 5);
  EXPECT_EQ(EvaluateSeries(series, 0, 2.0), 1);
}

TEST(EvaluatePartials, MatchThePolynomialsDerivativesForAnyOrder) {
  Series<Dual<2>> series;
  for (int k = 0; k <= kMaxOrder; ++k) {
    series[k].v.set(0, k + 1);
    series[k].v.set(1, 1);
  }
  double power = 1, weighted = 0, sum = 0;  // Σ 2^k, Σ (k + 1) 2^k
  for (int order = 0; order <= kMaxOrder; ++order, power *= 2) {
    weighted += (order + 1) * power;
    sum += power;
    const auto partials = EvaluatePartials(series, order, 2.0);
    EXPECT_EQ(partials[0], weighted) << order;
    EXPECT_EQ(partials[1], sum) << order;
  }
}

// ---- Special rates -----------------------------------------------------------------------------------------------

constexpr std::array kSpecialRates = {1.0, 2.0, 3.0};  // rad/s

// ω = ±(3.5 - 10 τ) passes 3 after 0.05 s, ω = ±(0.5 + 10 τ) passes 1 after 0.05 s.
TEST(FirstPassage, EndsAtTheFirstSpecialRateOnTheWay) {
  for (const double direction : {1.0, -1.0}) {
    const Series<double> slower = Coefficients({3.5 * direction, -10 * direction});
    const RatePassage down = FirstPassage(slower, 1, direction, {0.3, 0.5 * direction}, kSpecialRates);
    EXPECT_THAT(down.step, DoubleNear(0.05, 1e-15));
    EXPECT_EQ(down.end_rate, 3 * direction);
    const Series<double> faster = Coefficients({0.5 * direction, 10 * direction});
    const RatePassage up = FirstPassage(faster, 1, direction, {0.3, 3.5 * direction}, kSpecialRates);
    EXPECT_THAT(up.step, DoubleNear(0.05, 1e-15));
    EXPECT_EQ(up.end_rate, 1 * direction);
  }
}

TEST(FirstPassage, ComesBeforeAReversal) {
  const RatePassage passage = FirstPassage(Coefficients({1.5, -10}), 1, 1, {0.3, -1.5}, kSpecialRates);
  EXPECT_THAT(passage.step, DoubleNear(0.05, 1e-15));
  EXPECT_EQ(passage.end_rate, 1);
}

TEST(FirstPassage, IsNotTheRateAtWhichTheStepBegan) {
  const RatePassage passage = FirstPassage(Coefficients({2, -10}), 1, 1, {0.2, 0}, kSpecialRates);
  EXPECT_THAT(passage.step, DoubleNear(0.1, 1e-15));
  EXPECT_EQ(passage.end_rate, 1);
  EXPECT_EQ(FirstPassage(Coefficients({1, -10}), 1, 1, {0.2, -1}, kSpecialRates).step, 0.2);
}

TEST(FirstPassage, IsTheWholeStepIfNoSpecialRateIsPassed) {
  const RatePassage passage = FirstPassage(Coefficients({5, -10}), 1, 1, {0.1, 4}, kSpecialRates);
  EXPECT_EQ(passage.step, 0.1);
  EXPECT_EQ(passage.end_rate, 4);
}

// ω = 2.5 - 2 τ + 2 τ² is 2 at its least, after 0.5 s, and 2.5 again after 1 s.
TEST(FirstPassage, IsFoundWhereTheSpeedFallsAndRisesAgain) {
  const Series<double> over_the_top = Coefficients({2.5, -2, 2});
  const RatePassage whole = FirstPassage(over_the_top, 2, 1, {1, 2.5}, std::array{0.5});
  EXPECT_EQ(whole.step, 1);
  const RatePassage falling = FirstPassage(over_the_top, 2, 1, {1, 2.5}, std::array{2.18});
  EXPECT_THAT(falling.step, DoubleNear(0.2, 1e-12));  // 2.5 - 0.4 + 0.08
}

// ---- Direction of motion -----------------------------------------------------------------------------------------

TEST(DirectionOfMotion, FollowsTheRateHoweverSlow) {
  const Pendulum<CoulombFriction, double> stuck{Gravity::kSine, 0.04, {0, 2}};
  for (const double angle : {-0.5, 0.0, 0.5}) {
    EXPECT_EQ(DirectionOfMotion(stuck, angle, 1e-300), 1);
    EXPECT_EQ(DirectionOfMotion(stuck, angle, -3.0), -1);
  }
}

TEST(DirectionOfMotion, FollowsGravityFromRestBeyondDryFriction) {
  const Pendulum<CoulombFriction, double> linear{Gravity::kLinear, 0.04, {0.1, 0.25}};
  const Pendulum<CoulombFriction, double> sine{Gravity::kSine, 0.04, {0.1, 0.25}};
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(DirectionOfMotion(linear, sign * 0.2501, 0), -sign);
    EXPECT_EQ(DirectionOfMotion(linear, sign * 0.2499, 0), 0);
    EXPECT_EQ(DirectionOfMotion(sine, sign * (std::asin(0.25) + 1e-9), 0), -sign);
    EXPECT_EQ(DirectionOfMotion(sine, sign * (std::asin(0.25) - 1e-9), 0), 0);
    EXPECT_EQ(DirectionOfMotion(sine, sign * (kPi - 0.3), 0), -sign);
  }
}

TEST(DirectionOfMotion, IsZeroIfGravityEqualsDryFriction) {
  const Pendulum<CoulombFriction, double> linear{Gravity::kLinear, 0.04, {0, 0.25}};
  for (const double angle : {0.25, std::nextafter(0.25, 1.0), -0.25, std::nextafter(-0.25, -1.0)}) {
    EXPECT_EQ(DirectionOfMotion(linear, angle, 0), 0) << angle - 0.25;
  }
}

TEST(DirectionOfMotion, IsZeroOnlyAtTheBottomWithoutDryFriction) {
  const Pendulum<ViscousFriction, double> pendulum{Gravity::kSine, 0.04, {0.1}};
  EXPECT_EQ(DirectionOfMotion(pendulum, 0, 0), 0);
  EXPECT_EQ(DirectionOfMotion(pendulum, 1e-12, 0), -1);
  EXPECT_EQ(DirectionOfMotion(pendulum, -1e-12, 0), 1);
}

// ---- Expansion ---------------------------------------------------------------------------------------------------

template <typename T>
struct Expanded {
  Segment<T> angle;
  RateSeries<T> rate;
};

/// A swing expanded to the highest possible order.
template <FrictionModel F, typename T>
Expanded<T> ExpandedFrom(const Pendulum<F, T>& pendulum, double direction, const State<T>& state) {
  Expanded<T> swing;
  swing.angle.order = kMaxOrder;
  SwingExpansion<F, T>(pendulum, swing.angle, swing.rate).Expand(direction, state);
  return swing;
}

template <FrictionModel F>
Series<double> Expand(const Pendulum<F, double>& pendulum, double direction, double angle, double rate) {
  const auto swing = ExpandedFrom(pendulum, direction, State<double>{0, angle, rate});
  for (int n = 0; n < kMaxOrder; ++n) {
    EXPECT_DOUBLE_EQ(swing.rate.value[n], (n + 1) * swing.angle.angle[n + 1]) << "coefficient " << n;
  }
  return swing.angle.angle;
}

// θ = -s τ_c + (A + s τ_c) cos ω0 τ + (v / ω0) sin ω0 τ from the angle A and the rate v in direction s.
TEST(SwingExpansion, IsSineAndCosineForLinearGravityAndDryFriction) {
  const Pendulum<CoulombFriction, double> pendulum{Gravity::kLinear, 0.25, {0, 0.125}};
  for (const double direction : {1.0, -1.0}) {
    const Series<double> angle = Expand(pendulum, direction, 0.5, direction);
    const double cosine = 0.5 + direction * 0.125, sine = direction / 2;
    double power = 1;  // ω0^n / n!
    for (int n = 1; n <= kMaxOrder; ++n) {
      power *= 2.0 / n;
      const double expected = std::array{cosine, sine, -cosine, -sine}[n % 4] * power;
      EXPECT_DOUBLE_EQ(angle[n], expected) << "coefficient " << n;
    }
  }
}

// θ = π/2 + u, u'' = -cos u gives u = -τ²/2 + τ⁶/240 - τ¹⁰/19200 + ... by inserting the series into itself.
TEST(SwingExpansion, HasOneCoefficientInFourFromRestAtNinetyDegrees) {
  const Pendulum<ViscousFriction, double> pendulum{Gravity::kSine, 1, {0}};
  const Series<double> angle = Expand(pendulum, -1, std::acos(0.0), 0);
  const std::array<double, 13> expected = {std::acos(0.0), 0, -0.5, 0, 0, 0, 1.0 / 240, 0, 0, 0, -1.0 / 19200, 0, 0};
  for (int n = 0; n < 13; ++n) EXPECT_THAT(angle[n], DoubleNear(expected[n], 1e-16)) << "coefficient " << n;
}

// ---- Step length -------------------------------------------------------------------------------------------------

TEST(StepLength, IsTheSmallestStepOfTheLastFourCoefficients) {
  // (1e-12 / c)^(1/k) is 1/4 for c = 1e-12 · 4^k.
  for (int k = 7; k <= 10; ++k) {
    Series<double> angle{};
    angle[k] = -1e-12 * std::pow(4.0, k);
    EXPECT_THAT(StepLength(angle, 10, 1e-12, 9.0), DoubleNear(0.25, 1e-12)) << "coefficient " << k;
    for (int other = 7; other <= 10; ++other) {
      if (other != k) angle[other] = 1e-12 * std::pow(2.0, other);  // 1/2
    }
    EXPECT_THAT(StepLength(angle, 10, 1e-12, 9.0), DoubleNear(0.25, 1e-12)) << "coefficient " << k;
  }
}

TEST(StepLength, IsAtMostTheGivenMaximum) {
  Series<double> angle{};
  EXPECT_EQ(StepLength(angle, 10, 1e-12, 9.0), 9);
  angle[10] = 1e-12;
  EXPECT_EQ(StepLength(angle, 10, 1e-12, 0.5), 0.5);
}

// ---- Reversals ---------------------------------------------------------------------------------------------------

double Reversal(const Series<double>& rate, int order, double direction, double step) {
  return FirstSignChange(rate, order, direction, step, EvaluateSeries(rate, order, step));
}

// (0.5 - τ)(1 + τ²) has one root.
TEST(FirstSignChange, IsTheRootOfTheRateUpToTheEndOfTheStep) {
  const Series<double> rate = Coefficients({0.5, -1, 0.5, -1});
  EXPECT_THAT(Reversal(rate, 3, 1.0, 1.0), DoubleNear(0.5, 1e-15));
  EXPECT_THAT(Reversal(rate, 3, 1.0, 0.5), DoubleNear(0.5, 1e-15));
  EXPECT_THAT(Reversal(rate, 3, 1.0, 0.4999), Lt(0));
  const Series<double> mirrored = Coefficients({-0.5, 1, -0.5, 1});
  EXPECT_THAT(Reversal(mirrored, 3, -1.0, 1.0), DoubleNear(0.5, 1e-15));
  EXPECT_THAT(Reversal(mirrored, 3, -1.0, 0.4999), Lt(0));
}

// τ (0.25 - τ): the motion starts at the root 0.
TEST(FirstSignChange, IsTheNextRootFromRest) {
  const Series<double> rate = Coefficients({0, 0.25, -1});
  EXPECT_THAT(Reversal(rate, 2, 1.0, 1.0), DoubleNear(0.25, 1e-15));
  EXPECT_THAT(Reversal(rate, 2, 1.0, 0.2), Lt(0));
}

// 1 - 1e6 τ²: Halley's method alone, started at the end of the interval, would leave the interval.
TEST(FirstSignChange, IsFoundNearTheStartOfALongStep) {
  const Series<double> rate = Coefficients({1, 0, -1e6});
  EXPECT_THAT(Reversal(rate, 2, 1.0, 1.0), DoubleNear(1e-3, 1e-16));
  // 1e-9 - τ + τ³ / 2, flat near its end
  const Series<double> flat = Coefficients({1e-9, -1, 0, 0.5});
  EXPECT_THAT(Reversal(flat, 3, 1.0, 0.816), DoubleNear(1e-9, 1e-24));
}

template <DualNumber T>
State<T> StateAfter(const Expanded<T>& swing, const State<T>& start, double tau) {
  State<T> state{start.time + tau, T(EvaluateSeries(swing.angle.angle, kMaxOrder, tau)), T(0.0)};
  state.angle.v = EvaluateSeries(swing.angle.partials, kMaxOrder, tau);
  state.rate.v = EvaluatePartials(swing.rate.dual, kMaxOrder - 1, tau);
  return state;
}

// Linear, θ = v √I sin(τ / √I): for v = I = 1 the turning point is at τ = π √I / 2, θ = v √I. I and v carry
// derivatives.
TEST(StateAtReversal, HasTheDerivativesOfItsInstantAndAngle) {
  using Dual = pendulum::Dual<2>;
  const Pendulum<ViscousFriction, Dual> pendulum{Gravity::kLinear, Dual(1, 0), {Dual(0)}};
  const State<Dual> start{Dual(3.0), Dual(0.0), Dual(1, 1)};
  const auto swing = ExpandedFrom(pendulum, 1.0, start);
  const double root = Reversal(swing.rate.value, kMaxOrder - 1, 1.0, 1.6);
  EXPECT_THAT(root, DoubleNear(kPi / 2, 1e-15));
  const State<Dual> reversal = StateAtReversal(StateAfter(swing, start, root), -1.0);  // θ'' = -θ / I
  EXPECT_THAT(reversal.time.a, DoubleNear(3 + kPi / 2, 1e-14));
  EXPECT_THAT(reversal.time.v[0], DoubleNear(kPi / 4, 1e-13));  // d(π √I / 2)/dI
  EXPECT_THAT(reversal.time.v[1], DoubleNear(0, 1e-13));
  EXPECT_THAT(reversal.angle.a, DoubleNear(1, 1e-14));
  EXPECT_THAT(reversal.angle.v[0], DoubleNear(0.5, 1e-13));  // d(v √I)/dI
  EXPECT_THAT(reversal.angle.v[1], DoubleNear(1, 1e-13));
  EXPECT_EQ(reversal.rate.a, 0);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(reversal.rate.v[i], 0);
}

TEST(StateAtReversal, AddsToTheShiftOfPreviousReversals) {
  using Dual = pendulum::Dual<1>;
  const Pendulum<ViscousFriction, Dual> pendulum{Gravity::kLinear, Dual(1, 0), {Dual(0)}};
  State<Dual> start{Dual(0.0), Dual(0.0), Dual(1.0)};
  start.time.v.set(0, 10);
  const auto swing = ExpandedFrom(pendulum, 1.0, start);
  const State<Dual> reversal = StateAtReversal(StateAfter(swing, start, kPi / 2), -1.0);
  EXPECT_THAT(reversal.time.v[0], DoubleNear(10 + kPi / 4, 1e-13));
}

// θ = 1 + 3 τ + 5 τ², θ_p = 10 + 20 τ + 30 τ² at fixed τ, ∂start/∂p = 2.
Segment<Dual<1>> MovingParabola() {
  Segment<Dual<1>> segment;
  segment.start_partials.set(0, 2);
  segment.order = 2;
  segment.angle = Coefficients({1, 3, 5});
  for (int n = 0; n < 3; ++n) segment.partials[n].set(0, 10 * (n + 1));
  return segment;
}

// θ_p - 2 (3 + 10 τ).
TEST(PartialsAtFixedTime, CorrectForTheShiftOfTheStart) {
  const std::array<double, 3> expected = {4, 0, 30};
  for (int n = 0; n < 3; ++n) EXPECT_EQ(PartialsAtFixedTime(MovingParabola(), n)[0], expected[n]) << n;
}

// 3 + 10 τ, and 20 + 60 τ - 2 · 10.
TEST(RateOf, IsTheTimeDerivative) {
  const Segment<Dual<1>> rate = RateOf(MovingParabola());
  EXPECT_EQ(rate.order, 1);
  const std::array<double, 2> value = {3, 10};
  const std::array<double, 2> partial = {0, 60};
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(rate.angle[n], value[n]) << n;
    EXPECT_EQ(PartialsAtFixedTime(rate, n)[0], partial[n]) << n;
  }
}

TEST(RateOf, IsZeroAtRest) {
  Segment<Dual<1>> rest = MovingParabola();
  rest.order = 0;
  rest.angle[1] = std::numeric_limits<double>::quiet_NaN();  // coefficients beyond the order may have any value
  const Segment<Dual<1>> rate = RateOf(rest);
  EXPECT_EQ(rate.order, 0);
  EXPECT_EQ(rate.angle[0], 0);
  EXPECT_EQ(PartialsAtFixedTime(rate, 0)[0], 0);
}

TEST(Values, DropsTheDerivatives) {
  using Dual = pendulum::Dual<2>;
  const Pendulum<CoulombFriction, Dual> dual{Gravity::kLinear, Dual(0.04, 0), {Dual(0.5, 1), Dual(0.25)}};
  const Pendulum<CoulombFriction, double> values = Values(dual);
  EXPECT_EQ(values.gravity, Gravity::kLinear);
  EXPECT_EQ(values.inertia, 0.04);
  EXPECT_THAT(values.friction, testing::ElementsAre(0.5, 0.25));
}

}  // namespace
}  // namespace pendulum::swing_test
