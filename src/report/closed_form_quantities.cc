// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/closed_form_quantities.h"

#include <cmath>

#include "pendulum/model/friction/registry.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {
namespace {

/// Converts an estimate from units of the restoring torque G to SI if a rig gives G.
ReportedEstimate Reported(const ParameterInfo& info, const Estimate& estimate, const std::optional<Rig>& rig) {
  const double factor = rig && info.scales_with_gravity() ? rig->gravity_torque.value : 1;
  return {std::string(info.name),
          std::string(info.symbol),
          {factor * estimate.value, factor * estimate.std_error},
          std::string(rig ? info.unit : info.relative_unit)};
}

}  // namespace

std::vector<ReportedEstimate> LinearEstimates(const LogDecrement& linear, Gravity gravity,
                                              const std::optional<Rig>& rig) {
  std::vector<ReportedEstimate> estimates = {{"damped_frequency", "ω_d", linear.damped_frequency, "rad/s"},
                                             {"log_decrement", "δ", linear.log_decrement, "1"},
                                             {"damping_ratio", "ζ", linear.damping_ratio, "1"},
                                             {"natural_frequency", "ω_n", linear.natural_frequency, "rad/s"},
                                             Reported(kInertia, linear.inertia, rig),
                                             Reported(kViscous, linear.viscous, rig)};
  if (gravity.is_linear()) return estimates;
  estimates.push_back(Reported(kInertia, linear.corrected_inertia, rig));
  estimates.back().name = "corrected_inertia";
  return estimates;
}

std::vector<ReportedEstimate> DecrementEstimates(const TurningPointFit& decrement, const std::string& unit,
                                                 const std::optional<Rig>& rig) {
  const bool is_rate = decrement.table.quantity == Quantity::kRate;
  std::vector<ReportedEstimate> estimates = {Reported(is_rate ? kRateBias : kZeroAngle, decrement.zero, rig)};
  estimates.front().unit = unit;
  const std::vector<ParameterInfo> infos = PhysicalParameters(decrement.model);
  estimates.push_back(Reported(infos.front(), decrement.inertia, rig));
  for (std::size_t k = 0; k < decrement.friction.size(); ++k) {
    estimates.push_back(Reported(infos[k + 1], decrement.friction[k], rig));
  }
  return estimates;
}

std::optional<ReportedEstimate> StickingAngle(const TurningPointFit& decrement) {
  const std::vector<ReportedEstimate> relative = DecrementEstimates(decrement, "", std::nullopt);
  for (const auto& [name, symbol, coulomb, unit] : relative) {
    if (name != kCoulomb.name || !(coulomb.value > 0 && coulomb.value < 1)) continue;
    const double slope = 1 / std::sqrt(1 - coulomb.value * coulomb.value);
    return ReportedEstimate{"sticking_angle", "θ_s", {std::asin(coulomb.value), slope * coulomb.std_error}, "rad"};
  }
  return std::nullopt;
}

}  // namespace pendulum
