// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/presliding.h"

#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "tests/fitting/correlated_noise.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::presliding_test {
namespace {

/// 60 s from 0.1 rad, of which the last half are swings within the reach of the bristles.
SyntheticOptions BristleRun() {
  SyntheticOptions run = TextbookRun("dahl");
  run.parameters[1] = 0.0005 / kTextbookTorque;
  run.parameters[2] = 0.003 / kTextbookTorque;
  run.parameters[3] = 0.01;
  run.release_angle = 0.1;
  run.noise = 1e-5;
  run.duration = 60;
  return run;
}

// Below the reach θ_p bristles are a spring of stiffness τ_c / θ_p beside G (P. R. Dahl, 1968), which makes small
// swings faster by sqrt(1 + τ_c / (θ_p G)) - 1 = 8 % at most.
TEST(FindPresliding, FindsSmallSwingsThatBristlesMakeFaster) {
  const SyntheticOptions run = BristleRun();
  const std::optional<Presliding> found = FindPresliding(Must(SimulateRecording(run)), Gravity());
  ASSERT_TRUE(found);
  EXPECT_GT(found->faster, 0.05);
  EXPECT_LT(found->faster, std::sqrt(1 + run.parameters[2] / run.parameters[3]) - 1);
  EXPECT_LT(found->amplitude, 5 * run.parameters[3]);
}

TEST(FindPresliding, FindsNothingWhereFrictionIsDry) {
  SyntheticOptions run = BristleRun();
  run.model = Must(FindMotionModel("coulomb"));
  run.parameters.resize(3);
  EXPECT_FALSE(FindPresliding(Must(SimulateRecording(run)), Gravity()));
}

// Slow noise moves turning points by 5 % of a half swing, more than the noise between neighbouring readings suggests.
TEST(FindPresliding, DoesNotTakeSlowNoiseForFasterSwings) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.duration = 20;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Recording recording = Must(SimulateRecording(run));
    recording.value += 4 * kCount * FirstOrderNoise(recording.size(), 0.9, 0, seed);
    EXPECT_FALSE(FindPresliding(recording, Gravity())) << seed;
  }
}

}  // namespace
}  // namespace pendulum::presliding_test
