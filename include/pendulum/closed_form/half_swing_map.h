// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The end of a half swing, which begins and ends at a rate of 0.
struct HalfSwingEnd {
  double amplitude = 0;   ///< rad from the zero, on the other side
  double duration = 0;    ///< s
  double peak_rate = 0;   ///< rad/s, the largest rate; like peak_delay only computed on request, otherwise 0
  double peak_delay = 0;  ///< s, from the start to the peak of the rate
};

/// The half swing of a pendulum released at an amplitude > 0 [rad; below π] that moves in `direction` (±1). friction:
/// parameters of any registered law, in units of the restoring torque G, of either sign. natural_frequency: at small
/// angles, rad/s. The relative error is below 1e-9 up to 120 deg (MODEL.md eq. (6.5)). Returns std::nullopt if friction
/// holds the pendulum or stops it before the other side. Cost: some microseconds.
std::optional<HalfSwingEnd> ComputeHalfSwing(const MotionModel& model, std::span<const double> friction,
                                             double amplitude, double natural_frequency, double direction = 1,
                                             bool wants_peak = false);

}  // namespace pendulum
