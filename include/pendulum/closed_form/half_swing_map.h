// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "pendulum/model/motion_model.h"

namespace pendulum {

/// What a half swing from rest to rest comes to.
struct HalfSwingEnd {
  double amplitude = 0;   ///< rad from the zero, on the other side
  double duration = 0;    ///< s
  double peak_rate = 0;   ///< rad/s, the largest on the way; 0 unless it is wanted. Likewise:
  double peak_delay = 0;  ///< s, from the start to the peak
};

/// Lets a pendulum go at an amplitude > 0 [rad; below π] to swing in `direction` (±1), under any registered friction
/// law (its parameters in units of G, of either sign) and small-angle natural frequency [rad/s]: exact to 1e-9 of
/// itself up to 120 deg (MODEL.md eq. (32)). Nothing where friction holds it or stops it short of the other side. Cost:
/// some microseconds.
std::optional<HalfSwingEnd> SwingThrough(const MotionModel& model, std::span<const double> friction, double amplitude,
                                         double natural_frequency, double direction = 1, bool wants_peak = false);

}  // namespace pendulum
