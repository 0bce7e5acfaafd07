// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/rig_quantities.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::rig_quantities_test {
namespace {

constexpr double kLength = 0.42;      // m
constexpr double kEarth = 9.81;       // m/s^2
constexpr double kInertiaSi = 0.079;  // kg m^2

/// A swing of 20 s with this G/I and b/I = 0.05 1/s, τ_c/I = 0.05 1/s^2.
Recording Swing(double gravity_over_inertia, Gravity gravity) {
  SyntheticOptions run = NoisyRun("coulomb", 3);
  run.model.gravity = gravity;
  run.parameters = {1 / gravity_over_inertia, 0.05 / gravity_over_inertia, 0.05 / gravity_over_inertia};
  run.duration = 20;
  return Must(SimulateRecording(run));
}

/// The fit without torque, with the quantities of the rig.
FitReport FitWith(const std::string& rig_text, const Recording& recording, const std::string& model = "coulomb") {
  const Rig rig = Must(ParseRig(rig_text, "rig.json"));
  FitOptions options = ModelOptions(model);
  if (rig.gives_torque) options.rig = rig;
  FitReport fit = Fit(recording, options);
  AddRigQuantities(rig, fit);
  return fit;
}

const DerivedQuantity* FindQuantity(const FitReport& fit, const std::string& name) {
  const auto found = std::ranges::find(fit.derived, name, &DerivedQuantity::name);
  return found == fit.derived.end() ? nullptr : &*found;
}

/// The quantity has this value within four standard errors, and a useful error and interval.
void ExpectQuantity(const FitReport& fit, const std::string& name, double truth, const std::string& unit) {
  SCOPED_TRACE(name);
  const DerivedQuantity* quantity = FindQuantity(fit, name);
  ASSERT_NE(quantity, nullptr);
  EXPECT_EQ(quantity->unit, unit);
  ASSERT_TRUE(quantity->std_error);
  EXPECT_NEAR(quantity->estimate, truth, 4 * *quantity->std_error);
  EXPECT_LT(*quantity->std_error, 0.05 * std::abs(truth));
  ASSERT_TRUE(quantity->lower95 && quantity->upper95);
  EXPECT_LT(*quantity->lower95, quantity->estimate);
  EXPECT_GT(*quantity->upper95, quantity->estimate);
}

TEST(AddRigQuantities, GivesGravityFromALength) {
  const FitReport fit = FitWith(R"({"length": {"value": 0.42, "std_dev": 0.001}})", Swing(kEarth / kLength, Gravity()));
  ExpectQuantity(fit, "gravity", kEarth, "m/s^2");
  EXPECT_NEAR(*FindQuantity(fit, "gravity")->systematic.Total(), kEarth * 0.001 / 0.42, 1e-4);
  EXPECT_EQ(FindQuantity(fit, "effective_length"), nullptr);
  EXPECT_EQ(fit.Find("inertia")->unit, "s^2");
}

TEST(AddRigQuantities, GivesALengthFromGravity) {
  const FitReport fit = FitWith(R"({"gravity": {"value": 9.81, "std_dev": 0.02}})", Swing(kEarth / kLength, Gravity()));
  ExpectQuantity(fit, "effective_length", kLength, "m");
  EXPECT_NEAR(*FindQuantity(fit, "effective_length")->systematic.Total(), kLength * 0.02 / 9.81, 1e-5);
  EXPECT_EQ(FindQuantity(fit, "gravity"), nullptr);
}

TEST(AddRigQuantities, GivesTheInertiaPerMassOfAPendulumWithLengthAndGravity) {
  // A uniform rod about its end: centre of mass at L/2, I/m = L²/3, effective length 2 L / 3.
  const double rod = 0.6;
  const FitReport fit = FitWith(R"({"length": {"value": 0.3, "std_dev": 0}, "gravity": {"value": 9.81, "std_dev": 0}})",
                                Swing(kEarth * rod / 2 / (rod * rod / 3), Gravity()));
  ExpectQuantity(fit, "effective_length", 2 * rod / 3, "m");
  ExpectQuantity(fit, "inertia_per_mass", rod * rod / 3, "m^2");
  EXPECT_FALSE(FindQuantity(fit, "effective_length")->systematic.Total());
}

TEST(AddRigQuantities, GivesTorquesFromAKnownInertia) {
  const FitReport fit = FitWith(R"({"inertia": {"value": 0.079, "std_dev": 0.001}, "mass": 0.475, "gravity": 9.81})",
                                Swing(22.8, Gravity()));
  ExpectQuantity(fit, "gravity_torque", 22.8 * kInertiaSi, "N m");
  ExpectQuantity(fit, "viscous_si", 0.05 * kInertiaSi, "N m s/rad");
  ExpectQuantity(fit, "coulomb_si", 0.05 * kInertiaSi, "N m");
  ExpectQuantity(fit, "center_of_mass", 22.8 * kInertiaSi / (0.475 * 9.81), "m");
  ExpectQuantity(fit, "effective_length", 9.81 / 22.8, "m");
  const DerivedQuantity& torque = *FindQuantity(fit, "gravity_torque");
  EXPECT_NEAR(*torque.systematic.Total() / torque.estimate, 0.001 / 0.079, 1e-9);
}

TEST(AddRigQuantities, GivesTheStiffnessOfASpringFromAKnownInertia) {
  const FitReport fit = FitWith(R"({"inertia": 0.079})", Swing(12.33, Gravity::kLinear), "linear_coulomb");
  ExpectQuantity(fit, "stiffness", 12.33 * kInertiaSi, "N m/rad");
  EXPECT_EQ(FindQuantity(fit, "gravity_torque"), nullptr);
}

TEST(AddRigQuantities, GivesInertiaAndFrictionOfASpringWithAStiffness) {
  const FitReport fit = FitWith(R"({"stiffness": 0.02})", Swing(12.33, Gravity::kLinear), "linear_coulomb");
  const ParameterEstimate& inertia = *fit.Find("inertia");
  EXPECT_EQ(inertia.unit, "kg m^2");
  EXPECT_NEAR(inertia.estimate, 0.02 / 12.33, 4 * *inertia.std_error);
  const ParameterEstimate& viscous = *fit.Find("viscous");
  EXPECT_NEAR(viscous.estimate, 0.05 * 0.02 / 12.33, 4 * *viscous.std_error);
}

/// The clock's scale changes G/I by its second power, and b/I by its first.
TEST(AddRigQuantities, AddsTheErrorOfTheClock) {
  Recording recording = Swing(22.8, Gravity());
  recording.clock_scale_std_dev = 1e-3;
  const FitReport length = FitWith(R"({"length": {"value": 0.43, "std_dev": 0}})", recording);
  const DerivedQuantity& gravity = *FindQuantity(length, "gravity");
  EXPECT_NEAR(*gravity.systematic.Total() / gravity.estimate, 2e-3, 1e-6);
  const FitReport inertia = FitWith(R"({"inertia": {"value": 0.079, "std_dev": 0}})", recording);
  const DerivedQuantity& viscous = *FindQuantity(inertia, "viscous_si");
  EXPECT_NEAR(*viscous.systematic.Total() / viscous.estimate, 1e-3, 1e-6);
  // The torque of a rig with mass is known apart from the clock: its error does not belong to g / (G/I).
  const FitReport torque =
      FitWith(R"({"length": 0.43, "mass": {"value": 0.4, "std_dev": 0.01}, "gravity": {"value": 9.81, "std_dev": 0}})",
              recording);
  const DerivedQuantity& effective = *FindQuantity(torque, "effective_length");
  EXPECT_NEAR(*effective.systematic.Total() / effective.estimate, 2e-3, 1e-6);
  EXPECT_EQ(torque.Find("inertia")->unit, "kg m^2");
}

}  // namespace
}  // namespace pendulum::rig_quantities_test
