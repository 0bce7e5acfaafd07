// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "pendulum/model/friction/friction_model.h"

namespace pendulum {

/// Parameters for any friction law, including laws added later. Each torque coefficient alone gives about `torque` (in
/// units of the restoring torque G) at rest or at 1 rad/s. The torques increase by a quarter of `torque` from one to
/// the next, so that no two cancel. A parameter that is not a torque, such as a reference rate, is 1, or a quarter of
/// its upper bound if that is finite; an angle is 0.05 rad. Ordered parameters keep their order.
template <FrictionModel F>
std::array<double, kFrictionParameters<F>> TypicalFriction(double torque) {
  const auto clamp = [](double value, const ParameterInfo& info) { return std::clamp(value, info.lower, info.upper); };
  const auto shape = [](const ParameterInfo& info) {
    if (info.unit == "rad") return 0.05;
    return std::isfinite(info.upper) ? 0.25 * info.upper : 1.0;
  };
  std::array<double, kFrictionParameters<F>> none{};
  for (int i = 0; i < kFrictionParameters<F>; ++i) {
    if (!F::kParameters[i].scales_with_gravity()) none[i] = shape(F::kParameters[i]);
  }
  std::array<double, kFrictionParameters<F>> typical = none;
  for (int i = 0; i < kFrictionParameters<F>; ++i) {
    if (!F::kParameters[i].scales_with_gravity()) continue;
    std::array<double, kFrictionParameters<F>> alone = none;
    alone[i] = 1;
    const double unit = std::max(F::Torque(0.0, 1.0, alone.data()), F::Torque(1.0, 1.0, alone.data()));
    typical[i] = clamp(torque * (1 + 0.25 * i) / unit, F::kParameters[i]);
  }
  if constexpr (HasOrder<F>) {
    double& larger = typical[F::kOrdered.larger];
    larger = std::max(larger, 1.5 * typical[F::kOrdered.smaller]);
  }
  return typical;
}

/// Whether the law can hold the pendulum at rest.
template <FrictionModel F>
bool HasDryFriction() {
  return !HasState<F> && F::Torque(0.0, 1.0, TypicalFriction<F>(1.0).data()) > 0;
}

}  // namespace pendulum
