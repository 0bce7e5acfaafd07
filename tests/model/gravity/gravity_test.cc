// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/gravity/gravity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/dual.h"
#include "tests/model/coefficients.h"

namespace pendulum::gravity_test {
namespace {

using testing::DoubleNear;

template <typename List>
struct TypesOf;
template <typename... Ls>
struct TypesOf<GravityModelList<Ls...>> {
  using Type = testing::Types<Ls...>;
};

struct LawName {
  template <typename L>
  static std::string GetName(int /*index*/) {
    return std::string(L::kName);
  }
};

/// Tests that every law in GravityModels must pass.
template <typename L>
class GravityLaw : public testing::Test {
 protected:
  /// Angles [rad] from 0 to below the highest point.
  static std::vector<double> Angles() {
    const double top = std::min(L::kTop, 10.0);
    return {0.0, 1e-9, 1e-3 * top, 0.1 * top, 0.3 * top, 0.5 * top, 0.8 * top, 0.99 * top};
  }
};

TYPED_TEST_SUITE(GravityLaw, TypesOf<GravityModels>::Type, LawName);

TYPED_TEST(GravityLaw, IsOddAndRestoresBelowTheTop) {
  for (const double angle : this->Angles()) {
    EXPECT_EQ(TypeParam::Torque(-angle), -TypeParam::Torque(angle)) << angle;
    if (angle > 0) {
      EXPECT_GT(TypeParam::Torque(angle), 0) << angle;
    }
  }
}

TYPED_TEST(GravityLaw, HasUnitSlopeAtTheBottom) { EXPECT_THAT(TypeParam::Torque(1e-8) / 1e-8, DoubleNear(1, 1e-15)); }

TYPED_TEST(GravityLaw, HasItsTorqueAsTheSlopeOfThePotential) {
  EXPECT_EQ(TypeParam::Potential(0), 0);
  for (const double angle : this->Angles()) {
    constexpr double kStep = 1e-5;
    const double slope = (TypeParam::Potential(angle + kStep) - TypeParam::Potential(angle - kStep)) / (2 * kStep);
    EXPECT_THAT(slope, DoubleNear(TypeParam::Torque(angle), 1e-9)) << angle;
  }
}

TYPED_TEST(GravityLaw, IsSteepestAtTheBottom) {
  for (const double angle : this->Angles()) {
    constexpr double kStep = 1e-3;
    const double rise = TypeParam::Torque(angle + kStep) - TypeParam::Torque(angle);
    EXPECT_LE(std::abs(rise), kStep * (1 + 1e-12)) << angle;
  }
}

TYPED_TEST(GravityLaw, HasAChordWhoseHalfSquareIsThePotential) {
  for (const double angle : this->Angles()) {
    const double chord = TypeParam::Chord(angle);
    EXPECT_THAT(0.5 * chord * chord, DoubleNear(TypeParam::Potential(angle), 1e-14 * (1 + angle * angle))) << angle;
    EXPECT_EQ(TypeParam::Chord(-angle), -chord) << angle;
    EXPECT_THAT(TypeParam::AngleOfChord(chord), DoubleNear(angle, 1e-13 * angle)) << angle;
  }
}

TYPED_TEST(GravityLaw, FindsTheAngleOfATorque) {
  for (const double torque : {-0.9, -1e-6, 0.0, 0.3, 1.0}) {
    const double angle = TypeParam::AngleAtTorque(torque);
    EXPECT_THAT(TypeParam::Torque(angle), DoubleNear(torque, 1e-15)) << torque;
    EXPECT_LE(std::abs(angle), 0.5 * kPi) << torque;
  }
}

TYPED_TEST(GravityLaw, FindsTheAngleOfATorqueAndAPotential) {
  for (const double angle : this->Angles()) {
    const double found = TypeParam::AngleAt(TypeParam::Torque(angle), TypeParam::Potential(angle));
    EXPECT_THAT(found, DoubleNear(angle, 1e-14 * (1 + angle))) << angle;
  }
}

// Energy is conserved, so with the chord c = C sin φ the period is 4 √I ∫ c/g(θ) dφ over a quarter turn of φ. The
// integrand is smooth and periodic: the trapezoidal rule converges exponentially.
TYPED_TEST(GravityLaw, HasThePeriodOfEnergyConservation) {
  constexpr int kIntervals = 4000;
  for (const double amplitude : this->Angles()) {
    if (amplitude < 1e-6) continue;
    double sum = 0.5;  // at φ = 0, c/g is 1
    for (int i = 1; i <= kIntervals; ++i) {
      const double chord = TypeParam::Chord(amplitude) * std::sin(0.5 * kPi * i / kIntervals);
      sum += (i == kIntervals ? 0.5 : 1.0) * chord / TypeParam::Torque(TypeParam::AngleOfChord(chord));
    }
    EXPECT_THAT(TypeParam::PeriodRatio(amplitude), DoubleNear(sum / kIntervals, 1e-12)) << amplitude;
  }
}

TYPED_TEST(GravityLaw, SaysWhetherItIsLinear) {
  const double angle = std::min(0.5 * TypeParam::kTop, 1.0);
  EXPECT_EQ(TypeParam::kIsLinear, TypeParam::Torque(angle) == angle * TypeParam::Torque(1e-9) / 1e-9);
}

/// θ(τ) = start + p (τ - 0.4 τ² + 0.05 τ⁵) with the parameter p = kRate.
constexpr double kRate = 1.3;
Series<double> AngleSeries(double start) {
  Series<double> angle{};
  angle[0] = start;
  angle[1] = kRate;
  angle[2] = -0.4 * kRate;
  angle[5] = 0.05 * kRate;
  return angle;
}

double Sum(const Series<double>& series, double tau) {
  double sum = 0;
  for (int n = kMaxOrder; n >= 0; --n) sum = sum * tau + series[n];
  return sum;
}

TYPED_TEST(GravityLaw, HasTheSeriesOfItsTorqueAndOfItsDerivative) {
  using T = Dual<1>;
  for (const double start : {0.4, -1.7, 3.0}) {
    const Series<double> angle = AngleSeries(start);
    Series<double> rate{}, torque{}, by_parameter{};
    Series<PartialsFor<T>> partials{};
    typename TypeParam::template Recurrence<T> next;
    for (int n = 1; n <= kMaxOrder; ++n) partials[n].set(0, angle[n] / kRate);
    const auto find = [&]<int n>() {
      if (n > 0) rate[n - 1] = n * angle[n];
      torque[n] = next.template Next<n>(angle, rate);
      by_parameter[n] = next.template PartialsOf<n>(partials)[0];
    };
    [&]<int... n>(std::integer_sequence<int, n...>) { (find.template operator()<n>(), ...); }
    (std::make_integer_sequence<int, kMaxOrder>());
    for (const double tau : {0.0, 0.1, 0.2}) {
      const double at = Sum(angle, tau);
      EXPECT_THAT(Sum(torque, tau), DoubleNear(TypeParam::Torque(at), 1e-13)) << tau;
      constexpr double kStep = 1e-5;
      const double slope = (TypeParam::Torque(at + kStep) - TypeParam::Torque(at - kStep)) / (2 * kStep);
      EXPECT_THAT(Sum(by_parameter, tau), DoubleNear(slope * (at - start) / kRate, 1e-9)) << tau;
    }
  }
}

// ---- Chosen at run time ------------------------------------------------------------------------------------------

TEST(Gravity, IsSineUnlessChosenOtherwise) { EXPECT_EQ(Gravity(), Gravity::kSine); }

TEST(Gravity, IsFoundByUniqueNames) {
  std::set<std::string_view> names;
  for (const std::string_view name : GravityModels::kNames) {
    EXPECT_TRUE(names.insert(name).second) << name;
    const std::optional<Gravity> gravity = Gravity::Named(name);
    ASSERT_TRUE(gravity) << name;
    EXPECT_EQ(gravity->name(), name);
  }
  EXPECT_EQ(Gravity::Named("sin"), Gravity::kSine);
  EXPECT_EQ(Gravity::Named("linear"), Gravity::kLinear);
  EXPECT_FALSE(Gravity::Named("moon"));
}

TEST(Gravity, HasTheFunctionsOfItsLaw) {
  EXPECT_EQ(Gravity::kSine.Torque(0.7), std::sin(0.7));
  EXPECT_EQ(Gravity::kLinear.Torque(0.7), 0.7);
  EXPECT_FALSE(Gravity::kSine.is_linear());
  EXPECT_TRUE(Gravity::kLinear.is_linear());
  EXPECT_EQ(Gravity::kSine.top(), kPi);
  EXPECT_EQ(Gravity::kLinear.top(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace pendulum::gravity_test
