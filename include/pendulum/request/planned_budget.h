// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pendulum/analysis/plan.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/sensor_errors.h"
#include "pendulum/request/simulation.h"

namespace pendulum {

/// Adds to each row of a plan what noise alone does not show: the errors of rig, sensor and clock. The row's recording
/// is written and identified as fit_pendulum does, and its fit says what these errors do to the estimates; that of the
/// base case is kept. A row whose recording cannot be identified has no total errors. Where no bound of the noise is
/// known, the fit's own error counts. simulation: that of the plan. rig: that of the simulation. sensor: what is stated
/// of it; otherwise it is assumed. Cost: a fit for each row, on all cores.
void AddTotalErrors(const Simulation& simulation, const std::optional<Rig>& rig,
                    const std::optional<SensorStatement>& sensor, Plan& plan);

}  // namespace pendulum
