// SPDX-License-Identifier: Apache-2.0
// Tests of the standard errors of FitTurningPoints, with 200 simulated recordings of the reference rig for each
// friction law.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/turning_point_fit.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::turning_point_fit_errors_test {
namespace {

constexpr int kSeeds = 200;
constexpr double kTorque = 1.803;  // N m

/// The reference rig's published I_O and release, 18 s at 100 Hz.
Decay ReferenceDecay() {
  Decay decay;
  decay.natural_frequency = std::sqrt(kTorque / 0.079);
  decay.amplitude = 0.423;
  decay.duration = 18;
  return decay;
}

/// Checks a standard deviation of 0.8 to 1.2, at most 2 of 200 values beyond 3, and a mean of 0 within 4 of its
/// standard deviations.
void ExpectStandardNormal(const std::vector<double>& z, const std::string& what) {
  double sum = 0, squares = 0;
  for (const double each : z) sum += each, squares += each * each;
  const auto count = static_cast<double>(z.size());
  const double mean = sum / count;
  const double std_dev = std::sqrt(squares / count - mean * mean);
  EXPECT_GT(std_dev, 0.8) << what;
  EXPECT_LT(std_dev, 1.2) << what;
  EXPECT_LT(std::abs(mean), 4 / std::sqrt(count)) << what;
  EXPECT_LE(std::ranges::count_if(z, [](double each) { return std::abs(each) > 3; }), 2) << what;
}

/// The decay with noise. The zero moves through the levels of the sensor from seed to seed.
Recording Read(const Recording& clean, double zero, double resolution, std::uint64_t seed) {
  constexpr double kNoise = 1e-3;  // rad
  Recording recording = WithNoise(clean, kNoise, seed);
  recording.value.array() += zero;
  recording.resolution = resolution;
  if (resolution > 0) recording.value = resolution * (recording.value / resolution).array().round();
  return recording;
}

void ExpectTrueErrors(const MotionModel& model, const Decay& decay, double resolution = 0) {
  const std::vector<double> friction = {decay.viscous, decay.coulomb, decay.drag};
  const std::size_t terms = PhysicalParameters(model).size() - 1;
  const Recording clean = SimulateDecay(decay);
  std::vector<std::vector<double>> z(2 + terms);
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const double zero = 0.01 + 1e-4 * static_cast<double>(seed);
    const TurningPointFit found = Must(FitTurningPoints(Read(clean, zero, resolution, seed), model));
    const auto add = [&](std::size_t k, const Estimate& estimate, double truth) {
      z[k].push_back((estimate.value - truth) / estimate.std_error);
    };
    add(0, found.zero, zero);
    add(1, found.inertia, 1 / (decay.natural_frequency * decay.natural_frequency));
    for (std::size_t k = 0; k < terms; ++k) add(2 + k, found.friction[k], friction[k]);
  }
  const std::vector<std::string> names = {"zero", "inertia", "viscous", "coulomb", "drag"};
  for (std::size_t k = 0; k < z.size(); ++k) ExpectStandardNormal(z[k], std::string(model.name) + ": " + names[k]);
}

TEST(TurningPointFitErrors, AreRightForViscousFriction) {
  Decay decay = ReferenceDecay();
  decay.viscous = 0.003 / kTorque;
  ExpectTrueErrors({"viscous", "viscous", Gravity::kSine}, decay);
}

TEST(TurningPointFitErrors, AreRightForDryFrictionAlone) {
  Decay decay = ReferenceDecay();
  decay.coulomb = 0.003 / kTorque;
  ExpectTrueErrors({"coulomb", "coulomb", Gravity::kSine}, decay);
}

TEST(TurningPointFitErrors, AreRightForViscousAndDryFrictionOnCounts) {
  Decay decay = ReferenceDecay();
  decay.viscous = decay.coulomb = 0.003 / kTorque;
  ExpectTrueErrors({"coulomb", "coulomb", Gravity::kSine}, decay, 0.003464);  // 0.1985 deg per count
}

TEST(TurningPointFitErrors, AreRightWithDrag) {
  Decay decay = ReferenceDecay();
  decay.viscous = decay.coulomb = 0.003 / kTorque;
  decay.drag = 0.002 / kTorque;
  ExpectTrueErrors({"drag", "drag", Gravity::kSine}, decay);
}

}  // namespace
}  // namespace pendulum::turning_point_fit_errors_test
