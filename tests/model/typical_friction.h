// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pendulum/model/friction/friction_model.h"

namespace pendulum {

/// Parameters for any friction law, also one that was added yesterday: alone, each parameter gives the torque `torque`
/// (in units of G) at 1 rad/s; one that alone gives none, such as a reference rate, is 1.
template <FrictionModel F>
std::array<double, kFrictionParameters<F>> TypicalFriction(double torque) {
  std::array<double, kFrictionParameters<F>> typical;
  for (int i = 0; i < kFrictionParameters<F>; ++i) {
    std::array<double, kFrictionParameters<F>> alone{};
    alone[i] = 1;
    const double unit_torque = F::Torque(1.0, 1.0, alone.data());
    const double value = unit_torque > 0 && std::isfinite(unit_torque) ? torque / unit_torque : 1.0;
    typical[i] = std::clamp(value, F::kParameters[i].lower, F::kParameters[i].upper);
  }
  return typical;
}

/// Whether the law can hold the pendulum at rest.
template <FrictionModel F>
bool HasDryFriction() {
  return F::Torque(0.0, 1.0, TypicalFriction<F>(1.0).data()) > 0;
}

}  // namespace pendulum
