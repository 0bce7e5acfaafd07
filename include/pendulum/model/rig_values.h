// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// The name of a rig that is given by values alone, for messages.
inline constexpr std::string_view kRigOfValuesName = "the rig given by flags";

/// The value and the standard deviation of an entry of Rig::source: a number or {"value", "std_dev"}, checked by
/// ParseRig. Without a stated standard deviation it is the NominalStdDev of the key.
inline double ValueOfEntry(const nlohmann::ordered_json& entry) {
  return entry.is_object() ? entry.at("value").get<double>() : entry.get<double>();
}
inline bool HasStdDev(const nlohmann::ordered_json& entry) { return entry.is_object() && entry.contains("std_dev"); }
inline double StdDevOfEntry(const RigKey& key, const nlohmann::ordered_json& entry) {
  return HasStdDev(entry) ? entry.at("std_dev").get<double>() : NominalStdDev(key.quantity, ValueOfEntry(entry));
}

/// As ParseRig, with `values`, an object with keys of the rig, in the place of those of the text. A rig that needs g
/// and has none gets the mean at sea level, with its variation from the equator to the poles as error; the warning
/// gravity_assumed is added to `warnings`.
Result<Rig> ParseRigWith(const nlohmann::ordered_json& values, std::string_view text, const std::string& name,
                         std::vector<Warning>& warnings);

/// As ParseRigWith, of the values alone. kInvalidArgument: they are no rig.
Result<Rig> RigOfValues(nlohmann::ordered_json values, std::vector<Warning>& warnings);

/// The warning rig_overridden, which names the flags of the values that replaced those of a rig file.
Warning OverrideWarning(const nlohmann::ordered_json& values);

}  // namespace pendulum
