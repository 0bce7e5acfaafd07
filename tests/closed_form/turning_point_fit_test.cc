// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/turning_point_fit.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/locate_turning_points.h"
#include "tests/closed_form/reference_swing.h"

namespace pendulum::turning_point_fit_test {
namespace {

using ::testing::HasSubstr;

constexpr MotionModel kViscousModel = {"viscous", "viscous", Gravity::kSine};
constexpr MotionModel kDragModel = {"drag", "drag", Gravity::kSine};

/// ω0 = 5 rad/s. SimulateDecay does not use this project's trajectory.
Decay AllThree() {
  Decay decay;
  decay.viscous = 0.002;
  decay.coulomb = 0.001;
  decay.drag = 0.001;
  decay.amplitude = 1.0;
  decay.duration = 25;
  return decay;
}

TEST(FitTurningPoints, RecoversAllThreeTermsAtLargeAmplitude) {
  const TurningPointFit found = Must(FitTurningPoints(SimulateDecay(AllThree()), kDragModel));
  EXPECT_NEAR(found.inertia.value * 25, 1, 1e-5);
  EXPECT_NEAR(found.zero.value, 0, 1e-5);
  EXPECT_NEAR(found.friction[0].value, 0.002, 1e-5);
  EXPECT_NEAR(found.friction[1].value, 0.001, 1e-5);
  EXPECT_NEAR(found.friction[2].value, 0.001, 1e-5);
}

TEST(FitTurningPoints, RecoversTheTermsFromARateToo) {
  Decay decay = AllThree();
  decay.quantity = Quantity::kRate;
  const TurningPointFit found = Must(FitTurningPoints(SimulateDecay(decay), kDragModel));
  EXPECT_NEAR(found.inertia.value * 25, 1, 1e-5);
  EXPECT_NEAR(found.friction[0].value, 0.002, 1e-5);
  EXPECT_NEAR(found.friction[1].value, 0.001, 1e-5);
  EXPECT_NEAR(found.friction[2].value, 0.001, 1e-5);
}

TEST(FitTurningPoints, KeepsTheUnitOfAnUncalibratedAngle) {
  constexpr double kCounts = 300;  // per radian
  const auto counts = [](double t) { return 512 + kCounts * 0.4 * std::exp(-0.02 * t) * std::cos(4.8 * t + 1); };
  Recording recording = Sample(counts, 20, 100);
  recording.unit = "counts";
  const TurningPointFit found = Must(FitTurningPoints(recording, {"linear", "viscous", Gravity::kLinear}));
  const double square = 4.8 * 4.8 + 0.02 * 0.02;  // ω_d² + (ζ ω0)²
  EXPECT_NEAR(found.zero.value, 512, 1e-3);
  EXPECT_NEAR(found.inertia.value * square, 1, 1e-6);
  EXPECT_NEAR(found.friction[0].value, 2 * 0.02 / square, 1e-6);
}

TEST(FitTurningPoints, ContinuesAcrossAGap) {
  const Recording gap = WithNoise(WithoutSamples(SimulateDecay(AllThree()), 9.0, 12.3), 1e-3, 5);
  const TurningPointFit found = Must(FitTurningPoints(gap, kDragModel));
  EXPECT_NEAR(found.inertia.value, 0.04, 4 * found.inertia.std_error);
  EXPECT_NEAR(found.friction[1].value, 0.001, 4 * found.friction[1].std_error);
  EXPECT_GT(found.Probability(), 1e-3);
}

TEST(FitTurningPoints, HasTheGradientOfItsTurningPoints) {
  const Recording recording = WithNoise(SimulateDecay(AllThree()), 1e-3, 1);
  TurningPointTable table = Must(LocateTurningPoints(recording));
  const std::vector<bool> all(3, true);
  const TurningPointFit before = Must(FitTurningPoints(table, kDragModel, all));
  const double change = 0.3 * std::sqrt(table.points[4].covariance(1, 1));
  table.points[4].value += change;
  const TurningPointFit after = Must(FitTurningPoints(table, kDragModel, all));
  const Eigen::VectorXd slope = before.gradient.col(9);  // with respect to the value of turning point 4
  EXPECT_NEAR((after.zero.value - before.zero.value) / change, slope[0], 0.02 * std::abs(slope[0]));
  EXPECT_NEAR((after.friction[1].value - before.friction[1].value) / change, slope[3], 0.02 * std::abs(slope[3]));
}

TEST(FitTurningPoints, RejectsAWrongLaw) {
  const Recording recording = WithNoise(SimulateDecay(AllThree()), 1e-3, 2);
  EXPECT_LT(Must(FitTurningPoints(recording, kViscousModel)).Probability(), 1e-6);
  EXPECT_GT(Must(FitTurningPoints(recording, kDragModel)).Probability(), 1e-3);
}

TEST(FitTurningPoints, NeedsMoreTurningPointsThanUnknowns) {
  Decay decay = AllThree();
  decay.duration = 2.5;  // three turning points: six numbers for seven unknowns
  const auto found = FitTurningPoints(SimulateDecay(decay), kDragModel);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(found.error().message(), HasSubstr("3 turning points are too few for the 7 unknowns"));
}

TEST(CompareEnvelopes, FindsTheOnlyTermPresent) {
  const std::vector<std::string> terms = {"viscous", "coulomb", "drag"};
  const std::vector<std::string> shapes = {"exponential", "straight line", "hyperbola"};
  for (std::size_t truth = 0; truth < terms.size(); ++truth) {
    Decay decay;
    decay.amplitude = 0.6;
    (truth == 0 ? decay.viscous : truth == 1 ? decay.coulomb : decay.drag) = 0.002;
    const TurningPointTable table = Must(LocateTurningPoints(WithNoise(SimulateDecay(decay), 1e-3, 11)));
    const EnvelopeComparison laws = Must(CompareEnvelopes(table, Gravity::kSine));
    ASSERT_EQ(laws.single.size(), 3U);
    for (std::size_t k = 0; k < terms.size(); ++k) {
      EXPECT_EQ(laws.single[k].term, terms[k]);
      EXPECT_EQ(laws.single[k].shape, shapes[k]);
      EXPECT_EQ(laws.single[k].probability > 1e-3, k == truth) << terms[truth] << ", as " << terms[k];
    }
  }
}

}  // namespace
}  // namespace pendulum::turning_point_fit_test
