// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "pendulum/model/motion_model.h"
#include "pendulum/model/parameter.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// How the zero of a direct sensor moves during a recording.
enum class ZeroMotion {
  kNone,
  kDrifts,  ///< Linearly with time: zero_drift or bias_drift.
  kLags,    ///< For event recordings: the zero is shifted against the direction of motion by the hysteresis.
};

/// The parameters of a fit in order: inertia, friction, the start (release_angle and release_time, or initial_angle and
/// initial_rate), then the sensor. The parameters of a direct sensor are zero_angle or rate_bias and, if its zero
/// moves, zero_drift, bias_drift or hysteresis.
std::vector<ParameterInfo> FitParameters(const MotionModel& model, StartKind start, Quantity quantity,
                                         ZeroMotion zero = ZeroMotion::kNone, const SensorModel& sensor = {});

/// Whether a parameter is a drift of the zero: zero_drift or bias_drift.
bool IsDrift(std::string_view name);

}  // namespace pendulum
