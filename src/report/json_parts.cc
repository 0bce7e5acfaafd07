// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json_parts.h"

#include <cmath>
#include <utility>

#include "pendulum/report/layout.h"

namespace pendulum {

using Json = nlohmann::ordered_json;

NumberObject& NumberObject::Set(const std::string& key, Json value) {
  object_[key] = std::move(value);
  return *this;
}

NumberObject& NumberObject::Set(const std::string& key, double value) {
  if (std::isfinite(value)) return Set(key, Json(value));
  AddReason(key + " is not a finite number");
  return Set(key, Json(nullptr));
}

NumberObject& NumberObject::Set(const std::string& key, const std::optional<double>& value, const std::string& reason) {
  if (value) return Set(key, *value);
  AddReason(reason);
  return Set(key, Json(nullptr));
}

void NumberObject::AddReason(const std::string& reason) {
  if (reason_.find(reason) == std::string::npos) reason_ += (reason_.empty() ? "" : "; ") + reason;
}

Json NumberObject::Done() {
  if (!reason_.empty()) object_["reason"] = reason_;
  return std::move(object_);
}

Json NumberOrNull(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json IntervalJson(const std::optional<double>& lower, const std::optional<double>& upper) {
  if (!lower && !upper) return nullptr;
  return Json::array({NumberOrNull(lower), NumberOrNull(upper)});
}

std::string KeyWithUnit(const std::string& name, const std::string& unit) { return name + "_" + KeySuffix(unit); }

}  // namespace pendulum
