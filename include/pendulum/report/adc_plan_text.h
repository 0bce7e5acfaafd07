// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "pendulum/recording/calibration/adc.h"

namespace pendulum {

/// What each sensor would resolve and between which angles, a line each, then in words where those saturate that do,
/// and the divider that would prevent it. Angles in deg from the middle of the travel.
std::string AdcPlanText(std::span<const AdcSensor> sensors);

}  // namespace pendulum
