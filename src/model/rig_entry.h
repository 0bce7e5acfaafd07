// SPDX-License-Identifier: Apache-2.0
// A value of a rig file as JSON: a number or {"value", "std_dev"}. The file was checked by ParseRig.
#pragma once

#include <nlohmann/json.hpp>

namespace pendulum {

inline double ValueOfEntry(const nlohmann::ordered_json& entry) {
  return entry.is_object() ? entry.at("value").get<double>() : entry.get<double>();
}

inline double StdDevOfEntry(const nlohmann::ordered_json& entry) {
  return entry.is_object() ? entry.value("std_dev", 0.0) : 0.0;
}

}  // namespace pendulum
