// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/friction/friction_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "tests/model/typical_friction.h"

namespace pendulum::friction_model_test {
namespace {

using testing::DoubleNear;
using testing::Ge;
using testing::HasSubstr;

template <typename List>
struct TypesOf;
template <typename... Fs>
struct TypesOf<FrictionModelList<Fs...>> {
  using Type = testing::Types<Fs...>;
};

struct LawName {
  template <typename F>
  static std::string GetName(int /*index*/) {
    return std::string(F::kName);
  }
};

/// Tests that every law in FrictionModels must pass.
template <typename F>
class FrictionLaw : public testing::Test {
 protected:
  static constexpr int kParameters = kFrictionParameters<F>;
  using Parameters = std::array<double, kParameters>;

  /// Random values within the bounds, over four decades above the lower bound.
  Parameters RandomParameters() {
    std::uniform_real_distribution<double> decade(-3.0, 1.0);
    Parameters p;
    for (int i = 0; i < kParameters; ++i) {
      const ParameterInfo& info = F::kParameters[i];
      p[i] = std::min(info.lower + std::pow(10.0, decade(generator_)), info.upper);
    }
    return p;
  }

  /// The parameters of the mirrored law: a parameter that may be negative changes its sign.
  static Parameters Mirrored(Parameters p) {
    for (int i = 0; i < kParameters; ++i) {
      if (F::kParameters[i].lower < 0) p[i] = -p[i];
    }
    return p;
  }

  std::mt19937_64 generator_{20260803};
};

TYPED_TEST_SUITE(FrictionLaw, TypesOf<FrictionModels>::Type, LawName);

/// Rates at rest, near rest, typical and fast [rad/s].
constexpr std::array kRates = {0.0, 1e-9, 1e-3, 0.4, 2.7, 30.0};

TYPED_TEST(FrictionLaw, IsOddIfSignedParametersChangeSign) {
  for (int trial = 0; trial < 20; ++trial) {
    const auto p = this->RandomParameters();
    const auto mirrored = this->Mirrored(p);
    for (const double rate : kRates) {
      EXPECT_EQ(TypeParam::Torque(-rate, -1.0, mirrored.data()), -TypeParam::Torque(rate, 1.0, p.data())) << rate;
    }
  }
}

TYPED_TEST(FrictionLaw, NeverAddsEnergy) {
  for (int trial = 0; trial < 200; ++trial) {
    const auto p = this->RandomParameters();
    for (const double rate : kRates) {
      for (const double direction : {1.0, -1.0}) {
        EXPECT_THAT(TypeParam::Torque(direction * rate, direction, p.data()) * direction, Ge(0)) << rate;
      }
    }
  }
}

TYPED_TEST(FrictionLaw, OpposesMotion) {
  const auto p = TypicalFriction<TypeParam>(1.0);
  EXPECT_GT(TypeParam::Torque(1.0, 1.0, p.data()), 0);
}

TYPED_TEST(FrictionLaw, IsNoFrictionWhenItsParametersAreAtTheirLowerBounds) {
  auto p = this->RandomParameters();
  for (int i = 0; i < static_cast<int>(p.size()); ++i) p[i] = TypeParam::kParameters[i].lower;
  for (const double rate : kRates) {
    EXPECT_EQ(TypeParam::Torque(rate, 1.0, p.data()), 0) << rate;
    EXPECT_EQ(TypeParam::Torque(-rate, -1.0, p.data()), 0) << rate;
  }
}

struct TorqueSeries {
  Series<double> coefficients;
  double largest = 0;  ///< Largest |T| on the contour, which bounds every coefficient.
};

/// Taylor coefficients 0..kMaxOrder of T(ω(τ)) by Cauchy's integral over the unit circle with 128 points. It uses only
/// the law, not its recurrence.
template <typename F>
TorqueSeries TorqueByContour(const Series<double>& rate, double direction,
                             const std::array<double, kFrictionParameters<F>>& p) {
  constexpr int kPoints = 128;
  using Complex = std::complex<double>;
  std::array<Complex, kFrictionParameters<F>> complex_p;
  std::copy(p.begin(), p.end(), complex_p.begin());
  std::array<Complex, kMaxOrder + 1> sums{};
  TorqueSeries series;
  for (int k = 0; k < kPoints; ++k) {
    const auto tau = [k](int power) { return std::polar(1.0, 2 * kPi * (k * power % kPoints) / kPoints); };
    Complex omega = 0;
    for (int n = 0; n <= kMaxOrder; ++n) omega += rate[n] * tau(n);
    const Complex torque = F::Torque(omega, direction, complex_p.data());
    series.largest = std::max(series.largest, std::abs(torque));
    for (int n = 0; n <= kMaxOrder; ++n) sums[n] += torque * tau(-n);
  }
  for (int n = 0; n <= kMaxOrder; ++n) series.coefficients[n] = sums[n].real() / kPoints;
  return series;
}

/// A rate that keeps its sign near τ = 0: ω_0 in direction·[0.5, 1], coefficient n below 0.3·0.5^n.
Series<double> RandomRate(std::mt19937_64& generator, double direction) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Series<double> rate;
  double scale = 0.3;
  for (double& c : rate) {
    c = scale * uniform(generator);
    scale *= 0.5;
  }
  rate[0] = direction * (0.75 + 0.25 * uniform(generator));
  return rate;
}

TYPED_TEST(FrictionLaw, RecurrenceIsTheTaylorSeriesOfTheTorque) {
  std::uniform_real_distribution<double> factor(0.5, 2.0);
  for (int trial = 0; trial < 40; ++trial) {
    const double direction = trial % 2 == 0 ? 1.0 : -1.0;
    auto p = TypicalFriction<TypeParam>(1.0);
    for (double& value : p) value *= factor(this->generator_);  // The series does not depend on bounds.
    const Series<double> rate = RandomRate(this->generator_, direction);
    const TorqueSeries expected = TorqueByContour<TypeParam>(rate, direction, p);
    Series<double> known;
    known.fill(std::numeric_limits<double>::quiet_NaN());
    typename TypeParam::template Recurrence<double> recurrence;
    if constexpr (FrictionWithState<TypeParam>) recurrence.Begin(TypeParam::SlidingStates(direction));
    for (int n = 0; n <= kMaxOrder; ++n) {
      known[n] = rate[n];  // The recurrence sees only coefficients 0..n, for n = 0, 1, 2, ... in order.
      ASSERT_THAT(recurrence(n, known, direction, p.data()),
                  DoubleNear(expected.coefficients[n], 1e-14 * expected.largest))
          << "coefficient " << n << " in trial " << trial;
    }
  }
}

TYPED_TEST(FrictionLaw, HasParametersThatAreNamedOnceAndExplained) {
  std::set<std::string_view> names;
  for (const ParameterInfo& info :
       {kInertia, kReleaseAngle, kReleaseTime, kInitialAngle, kInitialRate, kZeroAngle, kRateBias}) {
    names.insert(info.name);
  }
  for (const ParameterInfo& info : TypeParam::kParameters) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " is already the name of another parameter";
    EXPECT_FALSE(info.name.empty() || info.symbol.empty() || info.description.empty()) << info.name;
    EXPECT_FALSE(info.unit.empty() || info.relative_unit.empty()) << info.name;
  }
}

TYPED_TEST(FrictionLaw, HasBoundsThatKeepItFromAddingEnergy) {
  for (const ParameterInfo& info : TypeParam::kParameters) {
    EXPECT_THAT(info.lower, Ge(info.scales_with_gravity() ? 0 : -1)) << info.name;
    EXPECT_LT(info.lower, info.upper) << info.name;
  }
}

// If the torque is proportional to a parameter, the parameter is a torque too: its unit contains N m, its relative unit
// does not.
TYPED_TEST(FrictionLaw, ScalesWithGravityExactlyTheParametersThatAreTorques) {
  for (const ParameterInfo& info : TypeParam::kParameters) {
    EXPECT_EQ(info.scales_with_gravity(), info.unit.starts_with("N m")) << info.name;
    EXPECT_FALSE(info.relative_unit.starts_with("N m")) << info.name;
  }
}

TYPED_TEST(FrictionLaw, HasAFormulaWithTheRateAndEveryParameter) {
  const std::string_view formula = TypeParam::kFormula;
  EXPECT_THAT(formula, HasSubstr("th'"));
  std::vector<std::string_view> braced;
  for (std::size_t open = formula.find('{'); open != formula.npos; open = formula.find('{', open + 1)) {
    braced.push_back(formula.substr(open + 1, formula.find('}', open) - open - 1));
  }
  for (const std::string_view name : braced) {
    EXPECT_TRUE(std::any_of(TypeParam::kParameters.begin(), TypeParam::kParameters.end(),
                            [name](const ParameterInfo& info) { return info.name == name; }))
        << name;
  }
  for (const ParameterInfo& info : TypeParam::kParameters) EXPECT_THAT(braced, testing::Contains(info.name));
}

// ---- Each law in numbers computed by hand -------------------------------------------------------------------------

TEST(ViscousFriction, IsProportionalToTheRate) {
  const std::array p = {0.5};
  EXPECT_EQ(ViscousFriction::Torque(3.0, 1.0, p.data()), 1.5);
  EXPECT_EQ(ViscousFriction::Torque(0.0, 1.0, p.data()), 0);
}

TEST(CoulombFriction, AddsAConstantInTheDirectionOfMotion) {
  const std::array p = {0.5, 0.25};
  EXPECT_EQ(CoulombFriction::Torque(3.0, 1.0, p.data()), 1.75);
  EXPECT_EQ(CoulombFriction::Torque(-3.0, -1.0, p.data()), -1.75);
  EXPECT_EQ(CoulombFriction::Torque(0.0, 1.0, p.data()), 0.25);
}

TEST(DragFriction, AddsTheSquareOfTheRateInTheDirectionOfMotion) {
  const std::array p = {0.5, 0.25, 2.0};
  EXPECT_EQ(DragFriction::Torque(3.0, 1.0, p.data()), 19.75);
  EXPECT_EQ(DragFriction::Torque(-3.0, -1.0, p.data()), -19.75);
  EXPECT_EQ(DragFriction::Torque(0.0, -1.0, p.data()), -0.25);
}

// exp(-1) = 0.36787944117144233.
TEST(StribeckFriction, FallsFromStictionToCoulombAsTheRateGrows) {
  const std::array p = {0.5, 0.25, 0.75, 2.0};
  EXPECT_EQ(StribeckFriction::Torque(0.0, 1.0, p.data()), 0.75);
  EXPECT_DOUBLE_EQ(StribeckFriction::Torque(2.0, 1.0, p.data()), 1.0 + 0.25 + 0.5 * 0.36787944117144233);
  EXPECT_DOUBLE_EQ(StribeckFriction::Torque(-2.0, -1.0, p.data()), -1.25 - 0.5 * 0.36787944117144233);
  EXPECT_EQ(StribeckFriction::Torque(200.0, 1.0, p.data()), 100.25);
}

TEST(StribeckFriction, IsCoulombFrictionIfStictionIsNotLarger) {
  const std::array p = {0.5, 0.25, 0.25, 2.0};
  for (const double rate : {0.0, 0.3, 5.0}) {
    EXPECT_EQ(StribeckFriction::Torque(rate, 1.0, p.data()), CoulombFriction::Torque(rate, 1.0, p.data())) << rate;
  }
}

// exp(-36) = 2.3e-16 is half of the distance from 1 to the next number.
TEST(StribeckFriction, IsCoulombFrictionToRoundingBeyondItsSpecialRates) {
  const std::array p = {0.0, 0.25, 0.5, 2.0};
  EXPECT_EQ(StribeckFriction::SpecialRates(p.data()), (std::array{3.0, 6.0, 9.0, 12.0}));
  EXPECT_DOUBLE_EQ(StribeckFriction::Torque(12.0, 1.0, p.data()), 0.25);
}

TEST(AsymmetricFriction, IsLargerTowardsPositiveAngles) {
  const std::array p = {0.5, 0.25, 0.5};
  EXPECT_EQ(AsymmetricFriction::Torque(3.0, 1.0, p.data()), 1.875);
  EXPECT_EQ(AsymmetricFriction::Torque(-3.0, -1.0, p.data()), -1.625);
  EXPECT_EQ(AsymmetricFriction::Torque(0.0, -1.0, p.data()), -0.125);
}

// ---- The list ----------------------------------------------------------------------------------------------------

TEST(FrictionModels, HaveUniqueNamesOtherThanLinear) {
  std::set<std::string_view> names = {"linear"};
  for (const std::string_view name : FrictionModels::kNames) EXPECT_TRUE(names.insert(name).second) << name;
}

TEST(FrictionModels, VisitCallsTheNamedLawOnly) {
  for (const std::string_view name : FrictionModels::kNames) {
    std::vector<std::string_view> visited;
    EXPECT_TRUE(FrictionModels::Visit(name, [&]<typename F>() { visited.push_back(F::kName); }));
    EXPECT_THAT(visited, testing::ElementsAre(name));
  }
}

TEST(FrictionModels, VisitCallsNothingForAnUnknownName) {
  bool called = false;
  EXPECT_FALSE(FrictionModels::Visit("tar", [&]<typename F>() { called = true; }));
  EXPECT_FALSE(called);
}

TEST(FrictionModels, ForEachCallsEveryLawInTheOrderOfTheList) {
  std::vector<std::string_view> visited;
  FrictionModels::ForEach([&]<typename F>() { visited.push_back(F::kName); });
  EXPECT_THAT(visited, testing::ElementsAreArray(FrictionModels::kNames));
}

TEST(Dahl, SlidesLikeCoulombFrictionAndIsStiffestAtAReversal) {
  constexpr std::array p = {0.5, 0.25, 0.01};
  EXPECT_EQ(DahlFriction::Torque(3.0, 1.0, p.data()), 1.75);
  EXPECT_EQ(DahlFriction::TorqueAt(DahlFriction::SlidingStates(-1.0), p.data()), -0.25);
  EXPECT_DOUBLE_EQ(DahlFriction::Stiffness(p.data()), 50);  // τ_c (1 - s u) / θ_p with s u = -1
}

TEST(Load, IsInProportionToTheLoad) {
  constexpr std::array p = {0.5, 0.25};
  EXPECT_EQ(LoadFriction::Torque(3.0, 1.0, p.data()), 1.75);
  EXPECT_EQ(TorqueUnder<LoadFriction>(2.0, 3.0, 1.0, p.data()), 2.0);
  EXPECT_EQ(TorqueUnder<LoadFriction>(-2.0, -3.0, -1.0, p.data()), -2.0);
  EXPECT_EQ(TorqueUnder<LoadFriction>(0.0, 0.0, 1.0, p.data()), 0.0);
  EXPECT_EQ(TorqueUnder<CoulombFriction>(2.0, 3.0, 1.0, p.data()), 1.75);  // no other law depends on the load
}

}  // namespace
}  // namespace pendulum::friction_model_test
