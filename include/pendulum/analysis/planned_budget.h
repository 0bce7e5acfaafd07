// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/analysis/plan.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// Adds to each row of a plan what noise does not show: the errors of rig, sensor and clock. The row's recording is
/// simulated and fitted, and its fit says what these errors do to the estimates; that of the base case is kept. A row
/// whose recording cannot be fitted has no total errors. rig: that of the plan's values in SI. sensor: what is stated
/// of it; otherwise it has what SensorErrorsOf assumes. Cost: a fit for each row.
void AddTotalErrors(const std::optional<Rig>& rig, const std::optional<SensorStatement>& sensor, Plan& plan);

}  // namespace pendulum
