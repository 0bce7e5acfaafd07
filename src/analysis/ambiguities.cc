// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/ambiguities.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/uncertainty/systematic_errors.h"

namespace pendulum {
namespace {

constexpr int kAmbiguityDigits = 2;

std::string ShareText(double share) { return NumberText(100 * share, kAmbiguityDigits) + " %"; }

/// G/I [1/s²]; 0 if the fit does not have it.
double SquaredFrequency(const FitReport& fit) {
  const auto found = std::ranges::find(fit.derived, "gravity_over_inertia", &DerivedQuantity::name);
  return found == fit.derived.end() ? 0 : found->estimate;
}

Ambiguity YieldingSupport(const FitReport& fit, const std::optional<Rig>& rig) {
  constexpr double kCompliance = 1e-5;  // m/N
  Ambiguity one{"a support that yields (stand, table, camera arm)",
                "the fitted inertia is an effective one, larger than that of the pendulum",
                "swing another bob mass at the same place: the added inertia grows with the square of the mass, the "
                "pendulum's own with the mass. Or clamp the support, or read a second sensor on it"};
  const double squared = SquaredFrequency(fit);
  if (rig && squared > 0) {
    const double gravity = rig->gravity ? rig->gravity->value : kStandardGravity;
    one.meaning += "; a support that moves by 0.01 mm per newton adds " +
                   ShareText(InertiaOfYieldingSupport(rig->gravity_torque.value, squared, gravity, kCompliance)) +
                   " here";
  }
  return one;
}

Ambiguity ParallelSpring(const FitReport& fit) {
  constexpr double kLarge = 0.5 * kPi;  // rad
  Ambiguity one{"a spring, cable or hose that adds torque at the axis",
                "the fitted inertia and friction are too small by the spring's share of G: 1 % of G makes 1 % less",
                "swing another bob mass: G changes, the spring does not. Or compare a small swing with a large one, "
                "with a sensor whose gain is known: only gravity makes large swings slower"};
  const ParameterEstimate* const inertia = fit.Find(kInertia.name);
  if (inertia != nullptr && inertia->std_error && inertia->estimate > 0) {
    const double share = SmallestVisibleSpring(*inertia->std_error / inertia->estimate, kLarge);
    if (share < 1) {
      one.experiment += ". With this noise a swing of 90 deg beside a small one shows a spring from " +
                        ShareText(share) + " of G on; simulate_pendulum --plan gives the errors of other swings";
    }
  }
  return one;
}

Ambiguity WrongTorque(const std::optional<Rig>& rig, bool is_spring) {
  const std::string torque = is_spring ? "k" : "G";
  Ambiguity one{is_spring ? "a wrong stiffness" : "a wrong mass or length",
                "only ratios to " + torque +
                    " follow from the swing: inertia and all friction torques have the "
                    "relative error of " +
                    torque,
                is_spring ? "measure k with a known torque, or add a known inertia and swing again"
                          : "weigh the pendulum held horizontal: force times distance from the axis is G. Or add a "
                            "known mass at a known distance and swing again"};
  if (!rig) one.meaning += ", which is 1 here because no rig is given";
  return one;
}

Ambiguity Gears() {
  return {"gears, a belt or a motor at the axis",
          "the fitted inertia and friction include theirs: inertia and viscous friction times the square of the gear "
          "ratio, dry friction times the ratio",
          "swing without them, or with two bob masses: the inertia that remains for no mass is theirs"};
}

Ambiguity Gain() {
  return {"a wrong gain of the sensor",
          "with a linear restoring torque the swing does not show it: angles and dry friction have its relative error",
          "turn the axis by a known angle and calibrate the sensor"};
}

/// "viscous by 0.0004 N m s/rad": a parameter and how far it would be off.
std::string UnseenText(const ParameterEstimate& parameter) {
  const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
  return std::string(parameter.info.name) + " by " + NumberText(*parameter.unseen_friction, kAmbiguityDigits) + unit;
}

std::optional<Ambiguity> UnseenFriction(const FitReport& fit) {
  std::string changed;
  for (const ParameterEstimate* const parameter : ChangedByUnseenFriction(fit))
    changed += (changed.empty() ? "" : ", ") + UnseenText(*parameter);
  if (changed.empty()) return std::nullopt;
  return Ambiguity{"friction of another law (larger at rest, with the square of the rate, with the angle)",
                   "terms of 30 % of the whole friction (presliding: all of the dry one) would change the estimates, "
                   "unseen in these readings: " +
                       changed + " (standard deviations)",
                   "compare the laws (--models all), and record a longer swing from a larger angle down to rest"};
}

}  // namespace

std::vector<const ParameterEstimate*> ChangedByUnseenFriction(const FitReport& fit) {
  std::vector<const ParameterEstimate*> changed;
  for (const ParameterInfo& info : PhysicalParameters(fit.model)) {
    const ParameterEstimate* const parameter = fit.Find(info.name);
    if (parameter == nullptr || !parameter->unseen_friction) continue;
    const auto total = TotalStdError(parameter->std_error, parameter->systematic);
    if (total && *parameter->unseen_friction > *total) changed.push_back(parameter);
  }
  return changed;
}

double InertiaOfYieldingSupport(double gravity_torque, double squared_frequency, double gravity, double compliance) {
  const double first_moment = gravity_torque / gravity;  // kg m
  const double inertia = gravity_torque / squared_frequency;
  return first_moment * first_moment * squared_frequency * compliance / inertia;
}

double SmallestVisibleSpring(double relative_error, double amplitude) {
  constexpr double kVisible = 3;  // standard deviations of the difference
  return kVisible * std::sqrt(2.0) * relative_error * 8 / (amplitude * amplitude);
}

std::vector<Ambiguity> AmbiguitiesOf(const FitReport& fit, const std::optional<Rig>& rig) {
  if (fit.termination != Termination::kConverged) return {};
  const std::optional<Rig> si = rig && rig->gives_torque ? rig : std::nullopt;
  if (fit.model.gravity.is_linear()) return {WrongTorque(si, true), Gears(), Gain()};
  std::vector<Ambiguity> all = {YieldingSupport(fit, si), ParallelSpring(fit), WrongTorque(si, false), Gears()};
  if (std::optional<Ambiguity> unseen = UnseenFriction(fit)) all.push_back(*std::move(unseen));
  return all;
}

}  // namespace pendulum
