// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "pendulum/recording/calibration/adc.h"

namespace pendulum {

/// Resolution and angle range of each sensor, one per line, then sentences about sensors that saturate and the divider
/// that prevents it. Angles in deg from the middle of the travel.
std::string AdcPlanText(std::span<const AdcSensor> sensors);

}  // namespace pendulum
