// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/closed_form/decrement.h"
#include "pendulum/closed_form/estimate.h"
#include "pendulum/closed_form/log_decrement.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// A quantity in closed form as the report shows it.
struct ReportedEstimate {
  std::string name;    ///< As in JSON.
  std::string symbol;  ///< As in MODEL.md.
  Estimate estimate;   ///< In `unit`; as for a fit, the error of the rig is not in it.
  std::string unit;    ///< Of inertia and torques: SI with a rig, units of G without.
};

/// What the linear pendulum's formulas give, in the order of LogDecrement; with linear gravity nothing is corrected.
std::vector<ReportedEstimate> LinearEstimates(const LogDecrement& linear, Gravity gravity,
                                              const std::optional<Rig>& rig);

/// Zero, inertia and friction of a decrement, by the names of the fit's parameters; `unit` is that of the readings.
std::vector<ReportedEstimate> DecrementEstimates(const Decrement& decrement, const std::string& unit,
                                                 const std::optional<Rig>& rig);

/// The largest angle at which dry friction holds the pendulum, asin(τ_c / G) [rad]; nothing unless 0 < τ_c < G.
std::optional<ReportedEstimate> StickingAngle(const Decrement& decrement);

}  // namespace pendulum
