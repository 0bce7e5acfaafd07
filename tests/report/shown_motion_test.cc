// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/shown_motion.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::shown_motion_test {
namespace {

using testing::DoubleNear;

IdentifiedRecording WithSampling(Quantity quantity, double samples_per_period, int gaps) {
  IdentifiedRecording recording;
  recording.used.quantity = quantity;
  recording.sampling.emplace();
  recording.sampling->samples_per_period = samples_per_period;
  recording.sampling->gaps = gaps;
  return recording;
}

TEST(HidesMotion, IsSoOfFewSamplesGapsAndOtherQuantities) {
  EXPECT_FALSE(HidesMotion(WithSampling(Quantity::kAngle, 12, 0)));
  EXPECT_FALSE(HidesMotion(WithSampling(Quantity::kAngle, 0, 0)));  // unknown
  EXPECT_FALSE(HidesMotion({}));
  EXPECT_TRUE(HidesMotion(WithSampling(Quantity::kAngle, 11.9, 0)));
  EXPECT_TRUE(HidesMotion(WithSampling(Quantity::kAngle, 100, 1)));
  EXPECT_TRUE(HidesMotion(WithSampling(Quantity::kRate, 100, 0)));
}

// Released at 0.423 rad at 1.9 s; the zero of the sensor is 0.012 rad. The period is 1.3 s.
TEST(MotionToShow, BeginsWithTheReleaseAndReadsTheSensor) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.noise = 1e-6;
  const Recording used = Must(SimulateRecording(run));
  const ShownMotion motion = MotionToShow(used, Fit(used, ModelOptions("coulomb")), std::nullopt, 1e5).value();
  EXPECT_THAT(motion.start, DoubleNear(1.9, 1e-4));
  EXPECT_THAT(motion.interval, DoubleNear(1.315 / 60, 1e-3));
  EXPECT_THAT(motion.start + motion.interval * static_cast<double>(motion.angle.size() - 1),
              DoubleNear(used.time[used.size() - 1], 1e-9));
  EXPECT_THAT(motion.angle[0], DoubleNear(0.423, 1e-4));
  EXPECT_THAT(motion.rate[0], DoubleNear(0, 1e-3));
  EXPECT_THAT(motion.reading[0], DoubleNear(0.435, 1e-4));
}

TEST(MotionToShow, HasNoMoreStepsThanAllowed) {
  const Recording used = Must(SimulateRecording(NoisyRun()));
  EXPECT_EQ(MotionToShow(used, Fit(used, ModelOptions("coulomb")), std::nullopt, 50)->reading.size(), 51);
}

TEST(MotionToShow, IsNoneOfAFailedFit) {
  const Recording used = Must(SimulateRecording(NoisyRun()));
  EXPECT_FALSE(MotionToShow(used, FitReport(), std::nullopt, 1e5));
}

}  // namespace
}  // namespace pendulum::shown_motion_test
