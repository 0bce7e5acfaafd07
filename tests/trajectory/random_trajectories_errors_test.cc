// SPDX-License-Identifier: Apache-2.0
// Every law at random parameters within its bounds: 10,000 trajectories.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/trajectory/random_trajectories.h"

namespace pendulum::random_trajectories_errors_test {
namespace {

using testing::IsEmpty;

TEST(TenThousandRandomTrajectories, HaveTheErrorThatWasAskedFor) {
  EXPECT_THAT(InaccurateTrajectories(10'000, 20261129), IsEmpty());
}

}  // namespace
}  // namespace pendulum::random_trajectories_errors_test
