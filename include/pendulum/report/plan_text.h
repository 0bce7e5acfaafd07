// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/analysis/plan.h"
#include "pendulum/model/rig.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {

/// The plan in plain text: the base case's parameters ± total errors (PdgRounding), where these come from and what
/// would make them smaller, a line per row of the plan with total errors, standard errors and bias to two digits, the
/// amplitude of equal bias, and an explanation. With a rig, units of the restoring torque G are converted to SI. In the
/// table inertia and friction are in percent of their values (in their own units if the value is 0), start and zero in
/// their own units. "-" marks a missing value, with an explanation. Without total errors (AddTotalErrors) the standard
/// errors stand for them. kSummary: without the rows of the plan.
std::string PlanText(const Plan& plan, const std::optional<Rig>& rig, TextExtent extent = TextExtent::kAll);

}  // namespace pendulum
