// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/closed_form/log_decrement.h"
#include "pendulum/closed_form/turning_point_fit.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// A quantity in closed form for the report.
struct ReportedEstimate {
  std::string name;    ///< Name in JSON.
  std::string symbol;  ///< Symbol in MODEL.md.
  Estimate estimate;   ///< Estimate in `unit`; as in a fit, its error excludes the rig's error.
  std::string unit;    ///< Unit; inertia and torques are in SI with a rig, in units of the restoring torque G without.
};

/// Quantities from the linear pendulum's formulas, in the order of LogDecrement. For linear gravity the corrected
/// inertia is left out.
std::vector<ReportedEstimate> LinearEstimates(const LogDecrement& linear, Gravity gravity,
                                              const std::optional<Rig>& rig);

/// Zero, inertia and friction of a decrement, with the names of the fit's parameters. `unit`: unit of the readings.
std::vector<ReportedEstimate> DecrementEstimates(const TurningPointFit& decrement, const std::string& unit,
                                                 const std::optional<Rig>& rig);

/// The largest angle at which dry friction holds the pendulum, asin(τ_c / G) [rad]; std::nullopt unless 0 < τ_c < G.
std::optional<ReportedEstimate> StickingAngle(const TurningPointFit& decrement);

}  // namespace pendulum
