// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace pendulum {

/// A JSON object that explains its missing numbers: each is null, and `reason` says why.
class NumberObject {
 public:
  NumberObject& Set(const std::string& key, nlohmann::ordered_json value);

  /// A number; null with a reason if it is not finite.
  NumberObject& Set(const std::string& key, double value);

  /// A number that may be missing, with the reason.
  NumberObject& Set(const std::string& key, const std::optional<double>& value, const std::string& reason);

  /// Adds a reason; a repeated reason is added once.
  void AddReason(const std::string& reason);

  /// Returns the object and empties this one.
  nlohmann::ordered_json Done();

 private:
  nlohmann::ordered_json object_ = nlohmann::ordered_json::object();
  std::string reason_;
};

/// null if the number is missing or not finite.
nlohmann::ordered_json NumberOrNull(const std::optional<double>& value);

nlohmann::ordered_json TextOrNull(const std::string& text);

/// [lower, upper]; null if both are missing.
nlohmann::ordered_json IntervalJson(const std::optional<double>& lower, const std::optional<double>& upper);

/// An array with `item_of(item)` for each item.
template <typename Range, typename ItemOf>
nlohmann::ordered_json ArrayOf(const Range& items, const ItemOf& item_of) {
  nlohmann::ordered_json array = nlohmann::ordered_json::array();
  for (const auto& item : items) array.push_back(item_of(item));
  return array;
}

/// A key with its unit: sigma_rad_s.
std::string KeyWithUnit(const std::string& name, const std::string& unit);

}  // namespace pendulum
