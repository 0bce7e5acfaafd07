// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace pendulum {

/// A JSON object whose missing numbers explain themselves: each is null, and `reason` says why.
class NumberObject {
 public:
  NumberObject& Set(const std::string& key, nlohmann::ordered_json value);

  /// null with a reason where the number is not finite.
  NumberObject& Set(const std::string& key, double value);

  /// A number that may be missing for the reason given.
  NumberObject& Set(const std::string& key, const std::optional<double>& value, const std::string& reason);

  /// A reason beside those said so far; each is said once.
  void Because(const std::string& reason);

  /// The object; empties this one.
  nlohmann::ordered_json Done();

 private:
  nlohmann::ordered_json object_ = nlohmann::ordered_json::object();
  std::string reason_;
};

/// null for a number that is absent or not finite.
nlohmann::ordered_json NumberOrNull(const std::optional<double>& value);

nlohmann::ordered_json TextOrNull(const std::string& text);

/// A key with its unit: sigma_rad_s.
std::string KeyWithUnit(const std::string& name, const std::string& unit);

}  // namespace pendulum
