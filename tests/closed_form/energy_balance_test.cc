// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/energy_balance.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/period.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::energy_balance_test {
namespace {

using testing::Each;
using testing::Ge;

std::vector<double> FrictionOf(const Recording& recording, std::string_view model) {
  const TurningPointTable table = Must(FindTurningPoints(recording));
  const double frequency = Must(NaturalFrequency(recording, table, Gravity::kSine));
  return FrictionFrom(BalanceEnergy(Must(FindMotionModel(model)), table, frequency).front());
}

/// Amplitudes of a swing with dry friction alone: τ (A + A') = cos A' - cos A, exact at any amplitude.
TurningPointTable DryHalfSwings(double amplitude, double coulomb, int count) {
  TurningPointTable table;
  table.points.push_back({.value = amplitude});
  for (int i = 0; i < count; ++i) {
    double next = amplitude;
    for (int iteration = 0; iteration < 50; ++iteration) {  // Newton's method
      const double excess = std::cos(next) - std::cos(amplitude) - coulomb * (amplitude + next);
      next -= excess / (-std::sin(next) - coulomb);
    }
    table.points.push_back({.value = next, .continues = true});
    amplitude = next;
  }
  return table;
}

TEST(FrictionFrom, IsExactForDryFrictionAtAnyAmplitude) {
  for (const double amplitude : {0.3, 1.5, 2.6}) {
    const TurningPointTable table = DryHalfSwings(amplitude, 0.01, 10);
    const std::vector<double> friction =
        FrictionFrom(BalanceEnergy(Must(FindMotionModel("coulomb")), table, 5).front());
    EXPECT_NEAR(friction[0], 0, 1e-8) << amplitude;
    EXPECT_NEAR(friction[1], 0.01, 1e-8) << amplitude;
  }
}

TEST(FrictionFrom, IsTheLogDecrementForSmallViscousSwings) {
  // A' = A exp(-π ζ / sqrt(1 - ζ²)), ζ = b ω0 / 2.
  const double viscous = 0.002, zeta = 0.5 * viscous * 5, ratio = std::exp(-kPi * zeta / std::sqrt(1 - zeta * zeta));
  TurningPointTable table;
  for (int i = 0; i <= 10; ++i) {
    table.points.push_back({.value = 0.01 * std::pow(ratio, i), .continues = i > 0});
  }
  EXPECT_NEAR(FrictionFrom(BalanceEnergy(Must(FindMotionModel("viscous")), table, 5).front())[0] / viscous, 1, 1e-4);
}

TEST(FrictionFrom, RecoversEachFrictionTermFromADecayWithThisTermOnly) {
  for (const double degrees : {20.0, 60.0, 100.0, 150.0}) {
    SCOPED_TRACE(degrees);
    Decay viscous, coulomb, drag;
    viscous.amplitude = coulomb.amplitude = drag.amplitude = degrees * kRadFromDeg;
    viscous.viscous = 0.004;
    coulomb.coulomb = 0.002;
    drag.drag = 0.001;
    EXPECT_NEAR(FrictionOf(SimulateDecay(viscous), "viscous")[0] / 0.004, 1, 0.03);
    const std::vector<double> dry = FrictionOf(SimulateDecay(coulomb), "coulomb");
    EXPECT_NEAR(dry[1] / 0.002, 1, 0.03);
    EXPECT_NEAR(dry[0], 0, 5e-5);  // dry friction of 0.002 would look like viscous friction of about 0.002
    const std::vector<double> air = FrictionOf(SimulateDecay(drag), "drag");
    EXPECT_NEAR(air[2] / 0.001, 1, 0.05);
    EXPECT_NEAR(air[1], 0, 5e-5);
  }
}

TEST(FrictionFrom, SeparatesAllThreeTerms) {
  for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
    for (const double degrees : {60.0, 100.0, 150.0}) {
      SCOPED_TRACE(std::to_string(degrees) + (quantity == Quantity::kRate ? " deg, rate" : " deg, angle"));
      Decay decay{5, 0.003, 0.003, 0.0006, degrees * kRadFromDeg, 60, quantity};
      const std::vector<double> friction = FrictionOf(SimulateDecay(decay), "drag");
      EXPECT_NEAR(friction[0] / 0.003, 1, 0.1);
      EXPECT_NEAR(friction[1] / 0.003, 1, 0.05);
      EXPECT_NEAR(friction[2] / 0.0006, 1, 0.1);
    }
  }
}

TEST(FrictionFrom, IsNeverNegative) {
  const auto undamped = [](double t) { return UndampedAngle(1.0, 1.0 / 25, t + 0.3); };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_THAT(FrictionOf(WithNoise(Sample(undamped, 20, 100), 0.01, seed), "drag"), Each(Ge(0.0))) << seed;
  }
  EXPECT_THAT(
      FrictionOf(Sample([](double t) { return 0.1 * std::exp(0.02 * t) * std::cos(5 * t); }, 20, 100), "coulomb"),
      Each(0.0));  // it gains energy
}

TEST(FrictionFrom, CountsNoLossAcrossAGap) {
  Decay decay;
  decay.viscous = 0.004;
  const Recording recording = WithoutSamples(SimulateDecay(decay), 8.03, 15.71);
  EXPECT_NEAR(FrictionOf(recording, "viscous")[0] / 0.004, 1, 0.03);
}

TEST(FrictionFrom, GivesAllParametersOfEveryModel) {
  const TurningPointTable table = DryHalfSwings(1.0, 0.01, 10);
  for (const MotionModel& model : MotionModels()) {
    EXPECT_EQ(FrictionFrom(BalanceEnergy(model, table, 5).front()).size() + 1, PhysicalParameters(model).size())
        << model.name;
  }
}

TEST(FrictionFrom, MatchesTheSimplerLawIfAParameterIsExcluded) {
  Decay decay{5, 0.003, 0.003, 0.0006, 60 * kRadFromDeg, 60, Quantity::kAngle};
  const TurningPointTable table = Must(FindTurningPoints(SimulateDecay(decay)));
  const EnergyBalance drag = BalanceEnergy(Must(FindMotionModel("drag")), table, 5).front();
  const std::vector<double> coulomb = FrictionFrom(BalanceEnergy(Must(FindMotionModel("coulomb")), table, 5).front());
  const std::vector<double> without = FrictionFrom(drag, {false, false, true});
  EXPECT_EQ(without[2], 0);
  EXPECT_NEAR(without[0] / coulomb[0], 1, 1e-9);
  EXPECT_NEAR(without[1] / coulomb[1], 1, 1e-9);
  EXPECT_EQ(FrictionFrom(drag, {true, true, true}), std::vector<double>(3, 0.0));
}

}  // namespace
}  // namespace pendulum::energy_balance_test
