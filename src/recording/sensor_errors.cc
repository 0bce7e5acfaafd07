// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

std::string_view SensorEffectName(SensorEffect effect) {
  static constexpr std::array<std::string_view, kSensorEffects.size()> kNames = {
      "gain", "cubic", "eccentric_sine", "eccentric_cosine", "lag", "backlash", "drift", "clock"};
  return kNames[static_cast<std::size_t>(effect)];
}

}  // namespace pendulum
