// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor_errors.h"

#include <set>
#include <string_view>

#include <gtest/gtest.h>

namespace pendulum::sensor_errors_test {
namespace {

TEST(SensorEffectName, IsDifferentForEachEffect) {
  std::set<std::string_view> names;
  for (const SensorEffect effect : kSensorEffects) names.insert(SensorEffectName(effect));
  EXPECT_EQ(names.size(), kSensorEffects.size());
  EXPECT_EQ(SensorEffectName(SensorEffect::kGain), "gain");
  EXPECT_EQ(SensorEffectName(SensorEffect::kEccentricCosine), "eccentric_cosine");
  EXPECT_EQ(SensorEffectName(SensorEffect::kClock), "clock");
}

TEST(SensorErrors, HasAPlaceForEachEffectAndStartsEmpty) {
  SensorErrors errors;
  EXPECT_TRUE(errors.kind.empty());
  double size = 0;
  for (const SensorEffect effect : kSensorEffects) {
    EXPECT_EQ(errors.Of(effect).std_dev, 0);
    EXPECT_TRUE(errors.Of(effect).source.empty());
    errors.Of(effect).std_dev = ++size;
  }
  size = 0;
  for (const EffectSize& each : errors.sizes) EXPECT_EQ(each.std_dev, ++size);
}

}  // namespace
}  // namespace pendulum::sensor_errors_test
