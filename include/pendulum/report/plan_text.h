// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/analysis/plan.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// The plan in plain text: the base case's parameters ± standard errors (PdgRounding), a line per row of the plan with
/// standard errors and bias to two digits, the amplitude of equal bias, and an explanation. rig: converts units of the
/// restoring torque G to SI; without it they stay. In the table inertia and friction are in percent of their values,
/// unless these are 0; start and zero are in their own units. "-" marks a missing value, with an explanation.
std::string PlanText(const Plan& plan, const std::optional<Rig>& rig);

}  // namespace pendulum
