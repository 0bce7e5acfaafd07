// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace pendulum {

struct JsonArray;
struct JsonObject;

/// A value of a large JSON text, in 16 bytes. Keys keep their order, and objects may have a million of them.
using JsonValue = std::variant<std::nullptr_t, bool, double, std::int64_t, std::unique_ptr<std::string>,
                               std::unique_ptr<JsonArray>, std::unique_ptr<JsonObject>>;

struct JsonArray {
  std::vector<JsonValue> items;
};

struct JsonObject {
  std::vector<std::pair<const std::string*, JsonValue>> members;  // Keys belong to the JsonKeys.
};

/// The keys of a text, each stored once.
using JsonKeys = std::set<std::string, std::less<>>;

/// What ParseJson found.
struct JsonFault {
  std::size_t byte = 0;  // Where, from 0.
  std::string reason;    // Empty if there is no fault.
};

/// Parses one value with nlohmann's parser. At most 32 nested brackets are allowed. NaN, Infinity and -Infinity, which
/// Python writes, become empty strings.
JsonFault ParseJson(std::string_view text, JsonKeys& keys, JsonValue& value);

/// A value as text on one line.
std::string JsonLine(const JsonValue& value);

/// The member of an object, or nullptr.
const JsonValue* FindMember(const JsonObject& object, std::string_view key);

inline const JsonArray* AsArray(const JsonValue& value) {
  const auto* array = std::get_if<std::unique_ptr<JsonArray>>(&value);
  return array == nullptr ? nullptr : array->get();
}

inline const JsonObject* AsObject(const JsonValue& value) {
  const auto* object = std::get_if<std::unique_ptr<JsonObject>>(&value);
  return object == nullptr ? nullptr : object->get();
}

inline const std::string* AsString(const JsonValue& value) {
  const auto* text = std::get_if<std::unique_ptr<std::string>>(&value);
  return text == nullptr ? nullptr : text->get();
}

inline bool IsScalar(const JsonValue& value) { return AsArray(value) == nullptr && AsObject(value) == nullptr; }

}  // namespace pendulum
