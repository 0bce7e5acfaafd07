// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pendulum::schema_check {

using Json = nlohmann::ordered_json;

/// Checks a value against a schema and lists violations. Supports $ref, oneOf, const, enum, type, required, properties,
/// additionalProperties, items, minimum, maximum, maxItems.
class SchemaCheck {
 public:
  explicit SchemaCheck(const Json& schema) : schema_(schema) {}

  std::vector<std::string> Faults(const Json& value) const {
    std::vector<std::string> faults;
    Check(value, schema_, "", faults);
    return faults;
  }

 private:
  static bool HasType(const Json& value, const std::string& type) {
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    return type == value.type_name();
  }

  static void CheckValue(const Json& value, const Json& schema, const std::string& at,
                         std::vector<std::string>& faults) {
    if (schema.contains("const") && value != schema["const"]) faults.push_back(at + ": const");
    if (schema.contains("enum")) {
      const Json& choices = schema["enum"];
      if (std::find(choices.begin(), choices.end(), value) == choices.end()) faults.push_back(at + ": enum");
    }
    if (schema.contains("type")) {
      const Json types = schema["type"].is_array() ? schema["type"] : Json::array({schema["type"]});
      bool fits = false;
      for (const Json& type : types) fits = fits || HasType(value, type.get<std::string>());
      if (!fits) faults.push_back(at + ": type " + value.type_name());
    }
    if (value.is_number() && schema.contains("minimum") && value < schema["minimum"])
      faults.push_back(at + ": minimum");
    if (value.is_number() && schema.contains("maximum") && value > schema["maximum"])
      faults.push_back(at + ": maximum");
  }

  void CheckMembers(const Json& value, const Json& schema, const std::string& at,
                    std::vector<std::string>& faults) const {
    if (schema.contains("required")) {
      for (const Json& key : schema["required"]) {
        if (!value.contains(key.get<std::string>())) faults.push_back(at + ": no " + key.get<std::string>());
      }
    }
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key)) {
        Check(member, properties[key], at + "/" + key, faults);
      } else if (schema.contains("additionalProperties")) {
        faults.push_back(at + ": " + key + " is not known");
      }
    }
  }

  void Check(const Json& value, const Json& schema, const std::string& at, std::vector<std::string>& faults) const {
    if (schema.contains("$ref")) {
      const std::string name = schema["$ref"].get<std::string>();
      Check(value, schema_["$defs"][name.substr(name.rfind('/') + 1)], at, faults);
    }
    if (schema.contains("oneOf")) {
      int fitting = 0;
      for (const Json& choice : schema["oneOf"]) {
        std::vector<std::string> own;
        Check(value, choice, at, own);
        fitting += own.empty() ? 1 : 0;
        if (!value.is_null() && !own.empty() && choice.contains("$ref"))
          std::ranges::copy(own, std::back_inserter(faults));
      }
      if (fitting != 1) faults.push_back(at + ": oneOf");
    }
    CheckValue(value, schema, at, faults);
    if (value.is_object()) CheckMembers(value, schema, at, faults);
    if (!value.is_array() || !schema.contains("items")) return;
    if (schema.contains("maxItems") && value.size() > schema["maxItems"]) faults.push_back(at + ": maxItems");
    for (std::size_t i = 0; i < value.size(); ++i) {
      Check(value[i], schema["items"], at + "/" + std::to_string(i), faults);
    }
  }

  const Json& schema_;
};

}  // namespace pendulum::schema_check
