// SPDX-License-Identifier: Apache-2.0
// Every law at random parameters within its bounds; random_trajectories_errors_test.cc has twenty times as many.
#include "tests/trajectory/random_trajectories.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/stribeck.h"

namespace pendulum::random_trajectories_test {
namespace {

using testing::IsEmpty;

TEST(RandomTrajectories, HaveTheErrorThatWasAskedFor) { EXPECT_THAT(InaccurateTrajectories(500, 20261128), IsEmpty()); }

// Friction falls from stiction to Coulomb friction within a range of rates that the pendulum passes in milliseconds or
// less, twice in each half swing.
TEST(RandomTrajectories, SeeANarrowStribeckZone) {
  for (const double stribeck_rate : {1e-6, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3}) {
    std::mt19937_64 generator(1);
    RandomTrajectory<StribeckFriction> swing(generator);
    swing.pendulum = {Gravity::kSine, 0.042, {0.002, 0.005, 0.02, stribeck_rate}};
    swing.start = {StartKind::kRelease, 0, 0.6, 0};
    swing.amplitude = 0.6;
    swing.end = 20;
    EXPECT_LE(ErrorOf(swing, 1e-8), 1e-8) << stribeck_rate << " rad/s";
  }
}

}  // namespace
}  // namespace pendulum::random_trajectories_test
