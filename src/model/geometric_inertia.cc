// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/geometric_inertia.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "pendulum/model/rig_values.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// The quantities that follow from a rig's description.
struct Inertias {
  double gravity_torque = 0;
  double own = 0;
  std::optional<double> point_mass;
};

std::optional<Inertias> InertiasOf(const Json& description) {
  const Result<Rig> rig = ParseRig(description.dump(), "rig");
  if (!rig || !rig->inertia) return std::nullopt;
  Inertias inertias{rig->gravity_torque.value, rig->inertia->value, std::nullopt};
  if (description.contains("rod_length")) {
    const double length = ValueOfEntry(description.at("rod_length"));
    const double mass = ValueOfEntry(description.at("bob_mass")) + ValueOfEntry(description.at("rod_mass"));
    inertias.point_mass = mass * length * length;
  }
  return inertias;
}

/// The description with one value increased by its standard deviation.
Json Varied(Json description, const RigKey& key) {
  Json& entry = description.at(key.name);
  entry = ValueOfEntry(entry) + StdDevOfEntry(key, entry);
  return description;
}

}  // namespace

std::vector<GeometricInertia> GeometricInertias(const Rig& rig, double fitted) {
  const std::optional<Inertias> base = InertiasOf(rig.source);
  if (!base) {  // The rig was not read from a file.
    if (!rig.inertia) return {};
    const auto [value, std_dev] = *rig.inertia;
    const double fitted_error = fitted * rig.gravity_torque.std_dev / rig.gravity_torque.value;
    return {{false, value, std_dev > 0 ? std::optional(std_dev) : std::nullopt, std::hypot(std_dev, fitted_error)}};
  }
  std::vector<GeometricInertia> all = {{false, base->own, std::nullopt, 0}};
  if (base->point_mass) all.push_back({true, *base->point_mass, std::nullopt, 0});
  for (GeometricInertia& inertia : all) {
    double variance = 0;
    double difference_variance = 0;
    for (const RigKey& key : RigKeys()) {
      if (!rig.source.contains(key.name) || StdDevOfEntry(key, rig.source.at(key.name)) == 0) continue;
      const std::optional<Inertias> varied = InertiasOf(Varied(rig.source, key));
      if (!varied) continue;
      const double change = (inertia.is_point_mass ? *varied->point_mass : varied->own) - inertia.value;
      const double fitted_change = fitted * (varied->gravity_torque / base->gravity_torque - 1);
      variance += change * change;
      difference_variance += (change - fitted_change) * (change - fitted_change);
    }
    if (variance > 0) inertia.std_error = std::sqrt(variance);
    inertia.difference_std_error = std::sqrt(difference_variance);
  }
  return all;
}

}  // namespace pendulum
