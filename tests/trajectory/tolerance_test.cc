// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/tolerance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/trajectory/trajectory.h"
#include "tests/model/undamped_pendulum.h"

namespace pendulum::tolerance_test {
namespace {

using testing::Ge;
using testing::Le;

/// The documented global error after 46 undamped small-angle periods, in local tolerances.
double Amplification(double amplitude) { return 400 + 10000 * std::pow(std::tan(amplitude / 2), 2); }

/// Largest error [rad] over 46 small-angle periods.
double GlobalError(double amplitude, double tolerance) {
  TraceOptions options;
  options.end = 46 * 2 * kPi * std::sqrt(kReferenceInertia);
  options.tolerance = tolerance;
  const Trajectory trajectory =
      MakeTrajectory({"viscous", "viscous", Gravity::kSine}, std::array{kReferenceInertia, 0.0},
                     {StartKind::kRelease, 0, amplitude, 0}, options)
          .value();
  double largest = 0;
  for (double time = 0.0317; time < options.end; time += 0.0971) {
    largest = std::max(largest, std::abs(trajectory.Angle(time) - UndampedAngle(amplitude, kReferenceInertia, time)));
  }
  return largest;
}

// Compares with the elliptic functions. Rounding is amplified like a tolerance of 2e-17 (measured). Beyond 177 deg
// rounding causes errors of more than 1e-10 rad.
TEST(TraceTolerance, KeepsTheRequestedErrorUpToRounding) {
  for (const double degrees : {1.0, 10.0, 24.0, 60.0, 90.0, 120.0, 150.0, 170.0, 175.0, 178.0, 179.0}) {
    const double amplitude = degrees * kRadFromDeg;
    const double rounding = 2e-17 * Amplification(amplitude);
    for (const double max_error : {1e-8, 1e-9, 1e-10}) {
      EXPECT_THAT(GlobalError(amplitude, TraceTolerance(max_error, amplitude)), Le(std::max(max_error, rounding)))
          << degrees << " deg, " << max_error << " rad";
    }
  }
}

TEST(TraceTolerance, IsWithinAFactorOfAHundredOfTheNeededTolerance) {
  for (const double degrees : {60.0, 90.0, 150.0}) {
    const double amplitude = degrees * kRadFromDeg;
    EXPECT_THAT(GlobalError(amplitude, 100 * TraceTolerance(1e-8, amplitude)), Ge(1e-8)) << degrees << " deg";
  }
}

TEST(TraceTolerance, ShrinksWithAmplitudeAndRequestedError) {
  double before = 1;
  for (double degrees = 0; degrees < 180; degrees += 0.5) {
    const double tolerance = TraceTolerance(1e-8, degrees * kRadFromDeg);
    EXPECT_THAT(tolerance, Le(before)) << degrees << " deg";
    EXPECT_THAT(tolerance, Ge(TraceTolerance(1e-9, degrees * kRadFromDeg))) << degrees << " deg";
    before = tolerance;
  }
}

TEST(TraceTolerance, IsAFourHundredthOfTheErrorForSmallSwings) { EXPECT_DOUBLE_EQ(TraceTolerance(4e-6, 0), 1e-8); }

TEST(TraceTolerance, IsIndependentOfTheSign) { EXPECT_EQ(TraceTolerance(1e-8, -1.2), TraceTolerance(1e-8, 1.2)); }

TEST(TraceTolerance, IsNeverBelowRounding) {
  EXPECT_EQ(TraceTolerance(0, 0.4), 1e-17);
  EXPECT_EQ(TraceTolerance(1e-20, 0.4), 1e-17);
  EXPECT_EQ(TraceTolerance(1e-12, kPi), 1e-17);
  EXPECT_EQ(TraceTolerance(1e-12, 20), 1e-17);  // a motion over the top has no amplitude
}

}  // namespace
}  // namespace pendulum::tolerance_test
