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

/// A key with its unit: sigma_rad_s.
std::string KeyWithUnit(const std::string& name, const std::string& unit);

}  // namespace pendulum
