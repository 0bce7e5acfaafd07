// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/rig_quantities.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pendulum {
namespace {

RigValue Times(const RigValue& x, const RigValue& y) {
  return {x.value * y.value, std::hypot(y.value * x.std_dev, x.value * y.std_dev)};
}

RigValue Over(const RigValue& x, const RigValue& y) {
  const double quotient = x.value / y.value;
  return {quotient, std::hypot(x.std_dev, quotient * y.std_dev) / y.value};
}

/// A ratio that the recording alone determines: G or a friction parameter over the inertia.
class Ratio {
 public:
  /// parameter: the name of the friction parameter; empty for G.
  Ratio(const FitReport& fit, std::string_view parameter) : quantity_(FindIn(fit, parameter)) {}

  bool exists() const { return quantity_ != nullptr; }

  /// factor · ratio
  DerivedQuantity Times(std::string name, std::string unit, const RigValue& factor) const {
    DerivedQuantity product{std::move(name), std::move(unit), factor.value * quantity_->estimate};
    const auto times = [&](const std::optional<double>& x) { return x ? std::optional(factor.value * *x) : x; };
    product.std_error = times(quantity_->std_error);
    product.lower95 = times(quantity_->lower95);
    product.upper95 = times(quantity_->upper95);
    product.systematic = quantity_->systematic.Scaled(factor.value);
    product.systematic.Add(ErrorSource::kRig, factor.std_dev * quantity_->estimate);
    return product;
  }

  /// dividend / ratio
  DerivedQuantity Divide(std::string name, std::string unit, const RigValue& dividend) const {
    const double ratio = quantity_->estimate;
    DerivedQuantity quotient{std::move(name), std::move(unit), dividend.value / ratio};
    if (quantity_->std_error) quotient.std_error = quotient.estimate / ratio * *quantity_->std_error;
    if (quantity_->upper95) quotient.lower95 = dividend.value / *quantity_->upper95;
    if (quantity_->lower95 && *quantity_->lower95 > 0) quotient.upper95 = dividend.value / *quantity_->lower95;
    quotient.systematic = quantity_->systematic.Scaled(quotient.estimate / ratio);
    quotient.systematic.Add(ErrorSource::kRig, dividend.std_dev / ratio);
    return quotient;
  }

 private:
  static const DerivedQuantity* FindIn(const FitReport& fit, std::string_view parameter) {
    const std::string name = (parameter.empty() ? "gravity" : std::string(parameter)) + "_over_inertia";
    const auto found = std::ranges::find(fit.derived, name, &DerivedQuantity::name);
    return found == fit.derived.end() || !(found->estimate >= 0) || fit.Find(kInertia.name) == nullptr ? nullptr
                                                                                                       : &*found;
  }

  const DerivedQuantity* quantity_;
};

/// What a known inertia makes of the ratios.
void AddTorques(const Rig& rig, const Ratio& gravity, const FitReport& fit, std::vector<DerivedQuantity>& derived) {
  const RigValue inertia = *rig.known_inertia;
  const bool is_spring = fit.model.gravity.is_linear();
  derived.push_back(gravity.Times(is_spring ? "stiffness" : "gravity_torque", is_spring ? "N m/rad" : "N m", inertia));
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (!parameter.info.scales_with_gravity() || parameter.info.name == kInertia.name) continue;
    const Ratio ratio(fit, parameter.info.name);
    if (!ratio.exists()) continue;
    derived.push_back(ratio.Times(std::string(parameter.info.name) + "_si", std::string(parameter.info.unit), inertia));
  }
  if (!rig.mass || !rig.gravity || is_spring) return;
  derived.push_back(gravity.Times("center_of_mass", "m", Over(inertia, Times(*rig.mass, *rig.gravity))));
}

}  // namespace

void AddRigQuantities(const Rig& rig, FitReport& fit) {
  const Ratio gravity(fit, "");
  if (!gravity.exists() || fit.derived.empty()) return;
  std::vector<DerivedQuantity> derived;
  if (rig.gravity && (rig.length || !rig.gives_torque))
    derived.push_back(gravity.Divide("effective_length", "m", *rig.gravity));
  if (rig.length) derived.push_back(gravity.Times("gravity", "m/s^2", *rig.length));
  if (rig.length && rig.gravity)
    derived.push_back(gravity.Divide("inertia_per_mass", "m^2", Times(*rig.gravity, *rig.length)));
  if (rig.known_inertia) AddTorques(rig, gravity, fit, derived);
  std::ranges::move(derived, std::back_inserter(fit.derived));
}

}  // namespace pendulum
