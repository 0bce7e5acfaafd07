// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/derived.h"

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::derived_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::Key;
using testing::Not;

using Quantities = std::map<std::string, DerivedQuantity>;

Quantities Derived(std::string_view model, const std::vector<double>& parameters, const Eigen::MatrixXd* covariance,
                   const std::vector<int>& at_bound = {}) {
  const std::vector<ParameterInfo> infos =
      FitParameters(Must(FindMotionModel(model)), StartKind::kMoving, Quantity::kAngle);
  std::vector<DerivedQuantity> derived = DerivedQuantities(infos, parameters);
  if (covariance != nullptr) SetDerivedErrors(*covariance, at_bound, derived);
  Quantities quantities;
  for (const DerivedQuantity& quantity : derived) quantities[quantity.name] = quantity;
  return quantities;
}

/// I 0.04 s², b 0.002 s, τ_c 0.003, c 0.0008 s²; start and zero.
const std::vector<double> kParameters = {0.04, 0.002, 0.003, 0.0008, 0.3, -0.7, 0.01};

/// A covariance of these parameters with correlations of both signs.
Eigen::MatrixXd Covariance() {
  const Eigen::VectorXd errors = Eigen::Map<const Eigen::VectorXd>(kParameters.data(), 7).cwiseAbs() * 0.01;
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(7, 7);
  correlation(0, 1) = correlation(1, 0) = 0.4;
  correlation(0, 2) = correlation(2, 0) = -0.3;
  correlation(1, 2) = correlation(2, 1) = -0.8;
  correlation(0, 3) = correlation(3, 0) = 0.2;
  return errors.asDiagonal() * correlation * errors.asDiagonal();
}

/// Definition of each quantity (ω0² = G / I, ζ = b ω0 / 2 G, T = 2 π / ω0, Q = 1 / 2 ζ, decay time 2 I / b).
const std::map<std::string, std::function<double(const Eigen::VectorXd&)>> kDefinitions = {
    {"natural_frequency", [](const Eigen::VectorXd& p) { return std::sqrt(1 / p[0]); }},
    {"small_angle_period", [](const Eigen::VectorXd& p) { return 2 * kPi * std::sqrt(p[0]); }},
    {"damping_ratio", [](const Eigen::VectorXd& p) { return 0.5 * p[1] * std::sqrt(1 / p[0]); }},
    {"quality_factor", [](const Eigen::VectorXd& p) { return 1 / (p[1] * std::sqrt(1 / p[0])); }},
    {"decay_time", [](const Eigen::VectorXd& p) { return 2 * p[0] / p[1]; }},
    {"gravity_over_inertia", [](const Eigen::VectorXd& p) { return 1 / p[0]; }},
    {"viscous_over_inertia", [](const Eigen::VectorXd& p) { return p[1] / p[0]; }},
    {"coulomb_over_inertia", [](const Eigen::VectorXd& p) { return p[2] / p[0]; }},
    {"drag_over_inertia", [](const Eigen::VectorXd& p) { return p[3] / p[0]; }},
};

/// Standard error by propagation, with central differences of the definition.
double PropagatedError(const std::function<double(const Eigen::VectorXd&)>& definition) {
  const Eigen::VectorXd p = Eigen::Map<const Eigen::VectorXd>(kParameters.data(), 7);
  Eigen::VectorXd gradient(7);
  for (Eigen::Index i = 0; i < 7; ++i) {
    const Eigen::VectorXd step = 1e-5 * std::abs(p[i]) * Eigen::VectorXd::Unit(7, i);
    gradient[i] = (definition(p + step) - definition(p - step)) / (2 * step[i]);
  }
  return std::sqrt(gradient.dot(Covariance() * gradient));
}

TEST(DerivedQuantities, MatchAPendulumOfFiveRadiansPerSecond) {
  const Quantities quantities = Derived("drag", kParameters, nullptr);
  const auto is = [](double value, const std::string& unit) {
    return AllOf(Field(&DerivedQuantity::estimate, DoubleNear(value, 1e-12 * value)),
                 Field(&DerivedQuantity::unit, unit));
  };
  EXPECT_THAT(quantities.at("natural_frequency"), is(5, "rad/s"));
  EXPECT_THAT(quantities.at("small_angle_period"), is(0.4 * kPi, "s"));
  EXPECT_THAT(quantities.at("damping_ratio"), is(0.005, "1"));
  EXPECT_THAT(quantities.at("quality_factor"), is(100, "1"));
  EXPECT_THAT(quantities.at("decay_time"), is(40, "s"));
  EXPECT_THAT(quantities.at("gravity_over_inertia"), is(25, "1/s^2"));
  EXPECT_THAT(quantities.at("viscous_over_inertia"), is(0.05, "1/s"));
  EXPECT_THAT(quantities.at("coulomb_over_inertia"), is(0.075, "1/s^2"));
  EXPECT_THAT(quantities.at("drag_over_inertia"), is(0.02, "1"));
  EXPECT_EQ(quantities.size(), kDefinitions.size());
}

TEST(DerivedQuantities, HaveTheErrorsOfNumericPropagation) {
  const Eigen::MatrixXd covariance = Covariance();
  const Quantities quantities = Derived("drag", kParameters, &covariance);
  for (const auto& [name, definition] : kDefinitions) {
    ASSERT_TRUE(quantities.at(name).std_error) << name;
    EXPECT_THAT(*quantities.at(name).std_error / PropagatedError(definition), DoubleNear(1, 1e-6)) << name;
  }
}

TEST(DerivedQuantities, HaveNoErrorsWithoutACovariance) {
  for (const auto& [name, quantity] : Derived("drag", kParameters, nullptr)) EXPECT_FALSE(quantity.std_error) << name;
}

TEST(DerivedQuantities, HaveNoErrorForAParameterAtItsBound) {
  Eigen::MatrixXd covariance = Covariance();
  covariance.row(2).setZero();
  covariance.col(2).setZero();
  std::vector<double> parameters = kParameters;
  parameters[2] = 0;
  const Quantities quantities = Derived("drag", parameters, &covariance, {2});
  EXPECT_FALSE(quantities.at("coulomb_over_inertia").std_error);
  EXPECT_EQ(quantities.at("coulomb_over_inertia").estimate, 0);
  EXPECT_TRUE(quantities.at("viscous_over_inertia").std_error);
  EXPECT_TRUE(quantities.at("natural_frequency").std_error);
}

TEST(DerivedQuantities, HaveNoQualityFactorWithoutDamping) {
  std::vector<double> parameters = kParameters;
  parameters[1] = 0;
  const Eigen::MatrixXd covariance = Covariance();
  const Quantities quantities = Derived("drag", parameters, &covariance);
  EXPECT_THAT(quantities, Not(Contains(Key("quality_factor"))));
  EXPECT_THAT(quantities, Not(Contains(Key("decay_time"))));
  // ζ = b / (2 sqrt(I)): at b = 0 its error is that of b divided by 2 sqrt(0.04).
  EXPECT_THAT(*quantities.at("damping_ratio").std_error, DoubleNear(0.00002 / 0.4, 1e-12));
}

TEST(DerivedQuantities, CoverOnlyTheModelsParameters) {
  const Quantities quantities = Derived("viscous", {0.04, 0.002, 0.3, -0.7, 0.01}, nullptr);
  EXPECT_THAT(quantities, Contains(Key("viscous_over_inertia")));
  EXPECT_THAT(quantities, Not(Contains(Key("coulomb_over_inertia"))));
  EXPECT_EQ(quantities.size(), 7);
}

// ---- Intervals -----------------------------------------------------------------------------------------------------

/// Quantities of the drag model with intervals for I in [0.0361, 0.0484] s², b and τ_c as given; c has no interval.
Quantities WithIntervals(const IntervalEnds& viscous, const IntervalEnds& coulomb,
                         const IntervalEnds& inertia = {0.0361, 0.0484}) {
  const std::vector<ParameterInfo> infos =
      FitParameters(Must(FindMotionModel("drag")), StartKind::kMoving, Quantity::kAngle);
  std::vector<DerivedQuantity> derived = DerivedQuantities(infos, kParameters);
  SetDerivedIntervals(infos, kParameters, {inertia, viscous, coulomb, {}, {}, {}, {}}, derived);
  Quantities quantities;
  for (const DerivedQuantity& quantity : derived) quantities[quantity.name] = quantity;
  return quantities;
}

void ExpectInterval(const DerivedQuantity& quantity, double lower, double upper) {
  ASSERT_TRUE(quantity.lower95 && quantity.upper95) << quantity.name;
  EXPECT_THAT(*quantity.lower95, DoubleNear(lower, 1e-9 * std::abs(upper))) << quantity.name;
  EXPECT_THAT(*quantity.upper95, DoubleNear(upper, 1e-9 * std::abs(upper))) << quantity.name;
}

/// sqrt(I) is 0.19, 0.2, 0.22 s; a larger I lowers ω0 and lengthens the period.
TEST(SetDerivedIntervals, PropagatesTheEndsOfOneParameter) {
  const Quantities quantities = WithIntervals({0.001, 0.003}, {0.003, 0.003});
  ExpectInterval(quantities.at("natural_frequency"), 1 / 0.22, 1 / 0.19);
  ExpectInterval(quantities.at("small_angle_period"), 0.38 * kPi, 0.44 * kPi);
  ExpectInterval(quantities.at("gravity_over_inertia"), 1 / 0.0484, 1 / 0.0361);
  ExpectInterval(quantities.at("coulomb_over_inertia"), 0.003 / 0.0484, 0.003 / 0.0361);  // τ_c is fixed
}

TEST(SetDerivedIntervals, AddsDistancesOfTwoParametersInQuadrature) {
  const Quantities quantities = WithIntervals({0.001, 0.003}, {0.003, 0.003});
  // ζ = b / (2 sqrt(I)) = 0.005. The ends of b give 0.0025 and 0.0075, those of I 0.001 / 0.22 and 0.001 / 0.19.
  ExpectInterval(quantities.at("damping_ratio"), 0.005 - std::hypot(0.0025, 0.005 - 0.001 / 0.22),
                 0.005 + std::hypot(0.0025, 0.001 / 0.19 - 0.005));
  // Q = sqrt(I) / b = 100. The ends of b give 66.7 and 200, those of I 95 and 110.
  ExpectInterval(quantities.at("quality_factor"), 100 - std::hypot(100 - 200.0 / 3, 5), 100 + std::hypot(100, 10));
  // b / I = 0.05. The ends of b give 0.025 and 0.075.
  ExpectInterval(quantities.at("viscous_over_inertia"), 0.05 - std::hypot(0.025, 0.05 - 0.002 / 0.0484),
                 0.05 + std::hypot(0.025, 0.002 / 0.0361 - 0.05));
}

TEST(SetDerivedIntervals, HasNoUpperQualityFactorIfFrictionMayBeZero) {
  const DerivedQuantity quality = WithIntervals({0.0, 0.004}, {0.003, 0.003}).at("quality_factor");
  EXPECT_FALSE(quality.upper95);
  EXPECT_THAT(*quality.lower95, DoubleNear(100 - std::hypot(50, 5), 1e-9));
}

TEST(SetDerivedIntervals, LeavesAnEndOpenIfAParameterLacksIt) {
  const Quantities quantities = WithIntervals({0.001, {}}, {0.003, 0.003});
  EXPECT_TRUE(quantities.at("damping_ratio").lower95);
  EXPECT_FALSE(quantities.at("damping_ratio").upper95);
  EXPECT_FALSE(quantities.at("quality_factor").lower95);
  EXPECT_TRUE(quantities.at("quality_factor").upper95);
  EXPECT_TRUE(quantities.at("natural_frequency").lower95 && quantities.at("natural_frequency").upper95);
  EXPECT_FALSE(quantities.at("drag_over_inertia").lower95 || quantities.at("drag_over_inertia").upper95);
}

// ---- Losses --------------------------------------------------------------------------------------------------------

std::vector<DerivedQuantity> LossesOf(std::string_view model, const std::vector<double>& parameters) {
  return LossQuantities(Must(FindMotionModel(model)), StartKind::kMoving, parameters, 5);
}

TEST(LossQuantities, AreSharesOfTheWindowAndOfItsFirstHalfSwing) {
  std::vector<std::string> names;
  double sum = 0;
  for (const DerivedQuantity& share : LossesOf("drag", kParameters)) {
    names.push_back(share.name);
    sum += share.estimate;
    EXPECT_EQ(share.gradient.size(), 7) << share.name;
    EXPECT_EQ(share.gradient[6], 0) << share.name;  // the zero
  }
  EXPECT_THAT(names, ElementsAre("viscous_loss_share", "drag_loss_share", "dry_loss_share",
                                 "viscous_loss_share_first_half_swing", "drag_loss_share_first_half_swing",
                                 "dry_loss_share_first_half_swing"));
  EXPECT_THAT(sum, DoubleNear(2, 1e-12));
}

TEST(LossQuantities, AreNoneIfThereIsNoChoice) {
  EXPECT_THAT(LossesOf("viscous", {0.04, 0.002, 0.3, -0.7, 0.01}), IsEmpty());
  EXPECT_THAT(LossesOf("coulomb", {0.04, 0.002, 5, 0.3, 0, 0.01}), IsEmpty());  // held
}

TEST(LossQuantities, HaveIntervalsFromZeroToOne) {
  std::vector<DerivedQuantity> shares = LossesOf("coulomb", {0.04, 0.002, 0.00001, 0.3, -0.7, 0.01});
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(6, 6);
  covariance(2, 2) = 1e-4;
  SetDerivedErrors(covariance, {}, shares);
  SetSymmetricIntervals(2, shares);
  for (const DerivedQuantity& share : shares) {
    EXPECT_EQ(*share.lower95, 0) << share.name;
    EXPECT_EQ(*share.upper95, 1) << share.name;
  }
}

TEST(LossQuantities, HaveNoErrorsBesideAParameterAtItsBound) {
  std::vector<DerivedQuantity> shares = LossesOf("coulomb", {0.04, 0.002, 0, 0.3, -0.7, 0.01});
  SetDerivedErrors(1e-8 * Eigen::MatrixXd::Identity(6, 6), {2}, shares);
  SetSymmetricIntervals(2, shares);
  for (const DerivedQuantity& share : shares) EXPECT_FALSE(share.std_error || share.lower95) << share.name;
}

}  // namespace
}  // namespace pendulum::derived_test
