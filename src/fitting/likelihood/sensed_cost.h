// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "pendulum/fitting/likelihood/trajectory_cost.h"

namespace pendulum {

/// The cost of readings by a sensor that is not direct. `data` must outlive it.
std::unique_ptr<TrajectoryCost> MakeSensedCost(const MotionModel& model, StartKind start, const TrajectoryData& data);

}  // namespace pendulum
