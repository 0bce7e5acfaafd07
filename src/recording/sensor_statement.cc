// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor_statement.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/try.h"

namespace pendulum {
namespace {

using SensorJson = nlohmann::ordered_json;

constexpr std::string_view kFormOfStatement = R"({"kind": "potentiometer", "gain": 0.003})";

constexpr std::array<std::string_view, 7> kKinds = {"potentiometer", "encoder",      "gyro", "accelerometer",
                                                    "camera",        "angle sensor", "ideal"};

/// A key of a statement, and the effects whose size it gives.
struct SizeKey {
  std::string_view key;
  std::vector<SensorEffect> effects;
};

const std::vector<SizeKey>& SizeKeys() {
  using enum SensorEffect;
  static const std::vector<SizeKey> keys = {
      {"gain", {kGain}},   {"nonlinearity", {kCubic, kEccentricSine, kEccentricCosine}},
      {"lag", {kLag}},     {"backlash", {kBacklash}},
      {"drift", {kDrift}}, {"clock", {kClock}}};
  return keys;
}

std::string KeyNames() {
  std::vector<std::string_view> names = {"kind"};
  for (const SizeKey& size : SizeKeys()) names.push_back(size.key);
  return NameList(names);
}

std::string KindRule() { return "it must be one of " + NameList(kKinds); }

Result<void> ReadKind(const SensorJson& value, const std::string& name, SensorStatement& statement) {
  if (!value.is_string() || !IsSensorKind(value.get_ref<const std::string&>())) {
    return Fault(name, "\"kind\" is " + JsonForMessage(value) + "; " + KindRule());
  }
  statement.kind = value.get<std::string>();
  return {};
}

/// The size of an effect. NaN fails the comparison.
Result<void> ReadSize(const SizeKey& size, const SensorJson& value, const std::string& name,
                      SensorStatement& statement) {
  constexpr double kLargest = 10;
  const double std_dev = value.is_number() ? value.get<double>() : -1;
  if (!(std_dev >= 0 && std_dev <= kLargest)) {
    return Fault(name, Quoted(size.key) + " is " + JsonForMessage(value) +
                           "; it must be a standard deviation, a number from 0 (exact) to 10 in SI units");
  }
  for (const SensorEffect effect : size.effects) statement.std_devs[static_cast<std::size_t>(effect)] = std_dev;
  return {};
}

Result<void> ReadSensorKey(const std::string& key, const SensorJson& value, const std::string& name,
                           SensorStatement& statement) {
  if (key == "schema_version") {
    if (value.is_null() || value == 1) return {};
    return Fault(name, "\"schema_version\" is " + JsonForMessage(value) + "; it must be 1");
  }
  const auto size = std::ranges::find(SizeKeys(), key, &SizeKey::key);
  if (key != "kind" && size == SizeKeys().end()) {
    return Fault(name, Quoted(key) + " is not a key of a sensor; the keys are " + KeyNames());
  }
  if (value.is_null()) return {};
  return key == "kind" ? ReadKind(value, name, statement) : ReadSize(*size, value, name, statement);
}

}  // namespace

std::span<const std::string_view> SensorKinds() { return kKinds; }

bool IsSensorKind(std::string_view text) { return std::ranges::find(kKinds, text) != kKinds.end(); }

Result<SensorStatement> ParseSensorStatement(std::string_view text, const std::string& name, std::string source) {
  SensorStatement statement;
  statement.source = std::move(source);
  if (IsSensorKind(text)) {
    statement.kind = text;
    return statement;
  }
  if (text.find('{') == std::string_view::npos) {
    return Fault(name, Quoted(text) + " is not a kind of sensor; " + KindRule() + ", or a JSON object such as " +
                           std::string(kFormOfStatement));
  }
  ASSIGN_OR_RETURN(const SensorJson json, ParseJsonObject(text, name, "sensor", kFormOfStatement));
  for (const auto& item : json.items()) {
    RETURN_IF_ERROR(ReadSensorKey(item.key(), item.value(), name, statement));
  }
  const bool has_size = std::ranges::any_of(statement.std_devs, [](const auto& size) { return size.has_value(); });
  if (statement.kind.empty() && !has_size) {
    return Fault(name, "the sensor states nothing; give at least one of " + KeyNames());
  }
  return statement;
}

}  // namespace pendulum
