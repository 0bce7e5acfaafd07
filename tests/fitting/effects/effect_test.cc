// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/effect.h"

#include <set>

#include <gtest/gtest.h>

namespace pendulum::effect_test {
namespace {

TEST(Cause, HasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (const Cause cause : kCauses) names.insert(CauseName(cause));
  EXPECT_EQ(names.size(), kCauses.size());
  EXPECT_EQ(CauseName(Cause::kPositionFriction), "position_friction");
}

TEST(Cause, OfTheSensorOrTheHandCanBeCorrectedAndFrictionCannot) {
  EXPECT_TRUE(IsOfSensor(Cause::kDrift));
  EXPECT_FALSE(IsOfSensor(Cause::kPush));
  EXPECT_TRUE(IsCorrectable(Cause::kHold));
  EXPECT_FALSE(IsCorrectable(Cause::kFrictionLaw));
}

}  // namespace
}  // namespace pendulum::effect_test
