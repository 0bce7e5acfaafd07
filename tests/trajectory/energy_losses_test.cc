// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/energy_losses.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum::energy_losses_test {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

MotionModel Model(std::string_view name) { return FindMotionModel(name).value(); }

TraceOptions Until(double end) {
  TraceOptions options;
  options.end = end;
  options.tolerance = 1e-13;
  return options;
}

EnergyLosses Losses(std::string_view model, StartKind start, const std::vector<double>& motion, double end) {
  return ComputeEnergyLosses(Model(model), start, motion, Until(end)).value();
}

/// A motion of each law that keeps moving for 6 s: I 0.04 s², friction, and the start at 0.5 rad.
struct Example {
  std::string model;
  std::vector<double> physical;
};

const std::vector<Example> kExamples = {{"coulomb", {0.04, 0.002, 0.004}},
                                        {"drag", {0.04, 0.002, 0.003, 0.0008}},
                                        {"stribeck", {0.04, 0.002, 0.003, 0.006, 0.2}},
                                        {"asymmetric", {0.04, 0.002, 0.004, 0.3}},
                                        {"dahl", {0.04, 0.002, 0.004, 0.01}},
                                        {"load", {0.04, 0.002, 0.004}},
                                        {"linear_coulomb", {0.04, 0.002, 0.004}}};

std::vector<double> Motion(const Example& example, double first, double second) {
  std::vector<double> motion = example.physical;
  motion.insert(motion.end(), {first, second});
  return motion;
}

/// ∫ f dt by Simpson's rule, which the code does not use.
template <typename F>
double Simpson(const F& f, double from, double to) {
  constexpr int kSteps = 60'000;
  const double step = (to - from) / kSteps;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) sum += (i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2) * f(from + i * step);
  return sum * step / 3;
}

/// ∫ |ω|^power dt.
double Integral(const Trajectory& trajectory, double from, double to, int power) {
  return Simpson([&](double time) { return std::pow(std::abs(trajectory.Rate(time)), power); }, from, to);
}

// ---- Names ---------------------------------------------------------------------------------------------------------

TEST(LossNames, AreOfTorquesThatGrowWithTheRateAndOfTheOthersTogether) {
  EXPECT_THAT(LossNames(Model("viscous")), ElementsAre("viscous"));
  EXPECT_THAT(LossNames(Model("coulomb")), ElementsAre("viscous", "dry"));
  EXPECT_THAT(LossNames(Model("drag")), ElementsAre("viscous", "drag", "dry"));
  EXPECT_THAT(LossNames(Model("stribeck")), ElementsAre("viscous", "dry"));
  EXPECT_THAT(LossNames(Model("dahl")), ElementsAre("viscous", "dry"));
}

TEST(LossNames, ContainViscousForEveryLaw) {
  for (const MotionModel& model : MotionModels()) EXPECT_THAT(LossNames(model), Contains("viscous")) << model.name;
}

// ---- Theory --------------------------------------------------------------------------------------------------------

/// Dry friction alone turns the linear pendulum at 0.43, -0.37, 0.31 ...: it takes (0.43² - 0.37²)/2 in the first half
/// swing, and everything at the end, at -0.01.
TEST(EnergyLosses, AreThoseOfTheStaircaseOfDryFriction) {
  const EnergyLosses losses = Losses("linear_coulomb", StartKind::kRelease, {0.04, 0, 0.03, 0.43, 1.9}, 12);
  EXPECT_THAT(losses.first_half_swing->energy, DoubleNear(0.5 * (0.43 * 0.43 - 0.37 * 0.37), 1e-12));
  EXPECT_THAT(losses.whole->energy, DoubleNear(0.5 * (0.43 * 0.43 - 0.01 * 0.01), 1e-12));
  EXPECT_THAT(losses.first_half_swing->share, ElementsAre(0, DoubleNear(1, 1e-12)));
  EXPECT_THAT(losses.whole->share, ElementsAre(0, DoubleNear(1, 1e-12)));
}

/// Released from A with viscous friction alone, the linear pendulum turns at -A exp(-π ζ/√(1 - ζ²)).
TEST(EnergyLosses, AreThoseOfTheLogDecrement) {
  constexpr double kInertia = 0.04, kViscous = 0.002, kAmplitude = 0.5;
  const EnergyLosses losses = Losses("linear", StartKind::kRelease, {kInertia, kViscous, kAmplitude, 0}, 5);
  const double zeta = 0.5 * kViscous / std::sqrt(kInertia);
  const double kept = std::exp(-2 * kPi * zeta / std::sqrt(1 - zeta * zeta));
  EXPECT_THAT(losses.first_half_swing->energy, DoubleNear(0.5 * kAmplitude * kAmplitude * (1 - kept), 1e-12));
  EXPECT_THAT(losses.whole->share, ElementsAre(DoubleNear(1, 1e-12)));
}

/// Constant torque takes the torque times the path, whatever else acts.
TEST(EnergyLosses, OfDryFrictionAreTorqueTimesPath) {
  const std::vector<double> motion = {0.04, 0.002, 0.004, 2.5, 0.3};
  constexpr double kEnd = 9;
  const EnergyLosses losses = Losses("coulomb", StartKind::kRelease, motion, kEnd);
  const Trajectory trajectory =
      MakeTrajectory(Model("coulomb"), {motion.data(), 3}, {StartKind::kRelease, 0.3, 2.5, 0}, Until(kEnd)).value();
  const double path = Integral(trajectory, 0.3, kEnd, 1);
  EXPECT_THAT(losses.whole->energy * losses.whole->share[1], DoubleNear(0.004 * path, 1e-7));
}

TEST(EnergyLosses, OfDragAreTheIntegralOfTheCubeOfTheRate) {
  const std::vector<double> motion = {0.04, 0.002, 0.003, 0.0008, 0.5, -0.7};
  constexpr double kEnd = 6;
  const EnergyLosses losses = Losses("drag", StartKind::kMoving, motion, kEnd);
  const Trajectory trajectory =
      MakeTrajectory(Model("drag"), {motion.data(), 4}, {StartKind::kMoving, 0, 0.5, -0.7}, Until(kEnd)).value();
  const LossShares& whole = *losses.whole;
  EXPECT_THAT(whole.energy * whole.share[0], DoubleNear(0.002 * Integral(trajectory, 0, kEnd, 2), 1e-9));
  EXPECT_THAT(whole.energy * whole.share[1], DoubleNear(0.0008 * Integral(trajectory, 0, kEnd, 3), 1e-9));
  EXPECT_THAT(whole.energy * whole.share[2], DoubleNear(0.003 * Integral(trajectory, 0, kEnd, 1), 1e-8));
}

/// Of a light bob on a rod the bearing's load is cos θ + I ω², so load friction alone takes τ_l ∫ |cos θ + I ω²| |ω|
/// dt.
TEST(EnergyLosses, OfFrictionUnderLoadAreTheIntegralOfTheLoad) {
  const std::vector<double> motion = {0.04, 0.001, 0.004, 0.8, 0};
  constexpr double kEnd = 6;
  const EnergyLosses losses = Losses("load", StartKind::kRelease, motion, kEnd);
  const Trajectory trajectory =
      MakeTrajectory(Model("load"), {motion.data(), 3}, {StartKind::kRelease, 0, 0.8, 0}, Until(kEnd)).value();
  const auto power = [&](double time) {
    const double rate = std::abs(trajectory.Rate(time));
    return 0.004 * std::abs(std::cos(trajectory.Angle(time)) + 0.04 * rate * rate) * rate;
  };
  EXPECT_THAT(losses.whole->energy * losses.whole->share[1], DoubleNear(Simpson(power, 0, kEnd), 1e-8));
}

TEST(EnergyLosses, GrowOfDryFrictionAsTheAmplitudeFalls) {
  for (const Example& example : kExamples) {
    const EnergyLosses losses = Losses(example.model, StartKind::kRelease, Motion(example, 0.5, 0.2), 6);
    const Eigen::Index dry = losses.whole->share.size() - 1;
    EXPECT_LT(losses.first_half_swing->share[dry], losses.whole->share[dry]) << example.model;
    EXPECT_THAT(losses.whole->share.sum(), DoubleNear(1, 1e-12)) << example.model;
  }
}

TEST(EnergyLosses, OfAMovingStartBeginWithTheFirstReversal) {
  const std::vector<double> released = {0.04, 0.002, 0.004, -0.5, 0};
  const EnergyLosses whole = Losses("coulomb", StartKind::kRelease, released, 6);
  // The same motion, seen from before its turning point: at -0.5 rad it rests for an instant.
  const Trajectory back =
      MakeTrajectory(Model("coulomb"), {released.data(), 3}, {StartKind::kRelease, 0, -0.5, 0}, Until(6)).value();
  const EnergyLosses from_middle =
      Losses("coulomb", StartKind::kMoving, {0.04, 0.002, 0.004, back.Angle(0.4), back.Rate(0.4)}, 5);
  ASSERT_TRUE(from_middle.first_half_swing);
  EXPECT_LT(from_middle.first_half_swing->energy, whole.first_half_swing->energy);  // it is the second one
  EXPECT_GT(from_middle.first_half_swing->energy, 0.8 * whole.first_half_swing->energy);
}

TEST(EnergyLosses, HaveNoHalfSwingIfNoneIsWhole) {
  const EnergyLosses losses = Losses("coulomb", StartKind::kMoving, {0.04, 0.002, 0.004, 0.0, 2.0}, 0.5);
  EXPECT_TRUE(losses.whole);
  EXPECT_FALSE(losses.first_half_swing);
}

TEST(EnergyLosses, AreAbsentOfAMotionThatLosesNothing) {
  const EnergyLosses losses = Losses("coulomb", StartKind::kRelease, {0.04, 0, 0, 0.5, 0}, 4);
  EXPECT_FALSE(losses.whole || losses.first_half_swing);
}

/// A constant torque shifts the point of rest and takes nothing: with linear gravity the motion is that of dry friction
/// about the shifted point.
TEST(EnergyLosses, AreThoseOfDryFrictionAloneBesideAConstantTorque) {
  constexpr double kViscous = 0.002, kDry = 0.004, kAsymmetry = 0.3;
  const EnergyLosses losses =
      Losses("asymmetric", StartKind::kRelease, {0.04, kViscous, kDry, kAsymmetry, 0.01, 0}, 0.6);
  const EnergyLosses shifted =
      Losses("linear_coulomb", StartKind::kRelease, {0.04, kViscous, kDry, 0.01 + kAsymmetry * kDry, 0}, 0.6);
  EXPECT_THAT(losses.whole->share[1], DoubleNear(shifted.whole->share[1], 1e-4));  // sin θ is θ to 1e-5
}

TEST(EnergyLosses, HaveDerivativesOverTheTop) {
  const std::vector<double> motion = {0.04, 0.002, 0.004, 0.3, 14};
  const auto share = [](const std::vector<double>& at) {
    return Losses("coulomb", StartKind::kMoving, at, 6).whole->share[0];
  };
  const Eigen::MatrixXd gradient = Losses("coulomb", StartKind::kMoving, motion, 6).whole->gradient;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    std::vector<double> more = motion, less = motion;
    const double step = 1e-6 * motion[i];
    more[i] += step;
    less[i] -= step;
    const double slope = (share(more) - share(less)) / (2 * step);
    EXPECT_THAT(gradient(0, static_cast<Eigen::Index>(i)), DoubleNear(slope, 1e-4 * (1 + std::abs(slope)))) << i;
  }
}

TEST(EnergyLosses, AreAbsentWithoutFriction) {
  const EnergyLosses losses = Losses("viscous", StartKind::kRelease, {0.04, 0, 0.5, 5}, 4);  // held to the end
  EXPECT_FALSE(losses.whole || losses.first_half_swing);
}

TEST(EnergyLosses, RefusesWhatCannotBeTraced) {
  const auto error = [](const std::vector<double>& motion) {
    return ComputeEnergyLosses(Model("coulomb"), StartKind::kRelease, motion, Until(5)).error().message();
  };
  EXPECT_THAT(error({0.04}), HasSubstr("takes 3 parameters, not 0"));
  EXPECT_THAT(error({-1, 0, 0.004, 0.5, 0}), HasSubstr("inertia is -1"));
  EXPECT_THAT(error({0.04, 0, 0.9, 0.5, 0}), HasSubstr("never moves"));
}

// ---- Derivatives ---------------------------------------------------------------------------------------------------

/// Shares of the whole motion and of the first half swing, one below the other.
Eigen::VectorXd AllShares(const Example& example, StartKind start, const std::vector<double>& motion, double end) {
  const EnergyLosses losses = Losses(example.model, start, motion, end);
  Eigen::VectorXd all(2 * losses.whole->share.size());
  all << losses.whole->share, losses.first_half_swing->share;
  return all;
}

Eigen::MatrixXd AllGradients(const EnergyLosses& losses) {
  Eigen::MatrixXd all(2 * losses.whole->gradient.rows(), losses.whole->gradient.cols());
  all << losses.whole->gradient, losses.first_half_swing->gradient;
  return all;
}

void ExpectGradients(StartKind start, double first, double second, double end) {
  for (const Example& example : kExamples) {
    const std::vector<double> motion = Motion(example, first, second);
    const Eigen::MatrixXd gradients = AllGradients(Losses(example.model, start, motion, end));
    const std::size_t last = motion.size() - (start == StartKind::kRelease ? 1 : 0);
    for (std::size_t i = 0; i < last; ++i) {
      const double step = 1e-5 * (std::abs(motion[i]) + 1e-3);
      std::vector<double> more = motion, less = motion;
      more[i] += step;
      less[i] -= step;
      const Eigen::VectorXd slope =
          (AllShares(example, start, more, end) - AllShares(example, start, less, end)) / (2 * step);
      const Eigen::VectorXd error = gradients.col(static_cast<Eigen::Index>(i)) - slope;
      EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-5 * (1 + slope.cwiseAbs().maxCoeff())) << example.model << " " << i;
    }
  }
}

TEST(EnergyLosses, HaveTheDerivativesOfDifferencesAfterARelease) { ExpectGradients(StartKind::kRelease, 0.5, 0.2, 6); }

TEST(EnergyLosses, HaveTheDerivativesOfDifferencesInMotion) { ExpectGradients(StartKind::kMoving, 0.3, -1.5, 6); }

}  // namespace
}  // namespace pendulum::energy_losses_test
