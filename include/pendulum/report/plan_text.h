// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/analysis/plan.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// The plan in plain text: the base case's parameters ± standard errors (PdgRounding), a line for each row of the plan
/// with standard errors and bias to two digits, the amplitude of equal bias, and how to read all that. rig: turns units
/// of G into SI; without one they stay. In the table inertia and friction are in percent of their values, unless these
/// are 0; start and zero are in their own units. "-" stands for what is absent, with a word why.
std::string PlanText(const Plan& plan, const std::optional<Rig>& rig);

}  // namespace pendulum
