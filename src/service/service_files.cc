// SPDX-License-Identifier: Apache-2.0
#include "service/service_files.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "pendulum/base/version.h"
#include "pendulum/model/gravity/registry.h"
#include "pendulum/request/run_flags.h"
#include "pendulum/web/page_parts.h"
#include "pendulum/web/service_page.h"

namespace pendulum {

std::span<const Example> Examples() {
  static const std::array<Example, 3> examples = {{
      {"recorded", "A run to rest",
       "A potentiometer on an Arduino, 46 s at 200 Hz until the pendulum rests: viscous and dry friction.",
       "viscous,coulomb,drag", RecordedRecording(), RecordedRig()},
      {"coulomb", "Twenty seconds with dry friction",
       "Simulated at 100 Hz with a 10-bit converter: does the decay look like a straight line or a curve?",
       "viscous,coulomb,drag", CoulombRecording(), TextbookRig()},
      {"textbook", "The textbook's rig", "Simulated with viscous friction alone, as textbooks have it.",
       "viscous,coulomb", TextbookRecording(), TextbookRig()},
  }};
  return examples;
}

namespace {

using Json = nlohmann::ordered_json;

/// The help text of a flag with all flag names as requests write them: without dashes.
std::string DescriptionOf(const RunFlag& flag) {
  std::string text = flag.help;
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;) text.erase(at, 2);
  return text;
}

Json ReferenceTo(std::string_view parameter) { return {{"$ref", "#/components/parameters/" + std::string(parameter)}}; }

/// Puts the flags of RunFlagTable in place of parameter RunFlags of each operation, and describes them.
void AddRunFlags(Json& document) {
  Json references = Json::array();
  for (const RunFlag& flag : RunFlagTable()) {
    if (flag.is_local) continue;
    const std::string name(flag.name);
    Json parameter = {{"name", name}, {"in", "query"}, {"description", DescriptionOf(flag)}, {"schema", flag.schema}};
    if (!flag.example.empty())
      parameter["example"] = flag.schema["type"] == "number" ? Json::parse(flag.example) : Json(flag.example);
    document["components"]["parameters"][name] = std::move(parameter);
    document["components"]["schemas"]["FitOptions"]["properties"][name] = {{"$ref", "#/components/schemas/FlagText"}};
    references.push_back(ReferenceTo(name));
  }
  for (Json& path : document["paths"]) {
    for (Json& operation : path) {
      if (!operation.is_object() || !operation.contains("parameters")) continue;
      Json parameters = Json::array();
      for (Json& parameter : operation["parameters"]) {
        if (parameter != ReferenceTo("RunFlags"))
          parameters.push_back(std::move(parameter));
        else
          parameters.insert(parameters.end(), references.begin(), references.end());
      }
      operation["parameters"] = std::move(parameters);
    }
  }
}

/// The flags that have a field in the form of the page.
Json FieldsJson() {
  Json fields = Json::array();
  for (const RunFlag& flag : RunFlagTable()) {
    if (flag.label.empty()) continue;
    Json words = Json::array();
    for (const auto& [word, label] : flag.words) words.push_back(Json::array({word, label}));
    const Json schema = flag.is_local ? Json{{"type", "file"}} : flag.schema;
    fields.push_back({{"name", flag.name},
                      {"label", flag.label},
                      {"help", flag.help},
                      {"unit", flag.unit},
                      {"type", schema["type"]},
                      {"default", schema.value("default", Json(""))},
                      {"words", std::move(words)}});
  }
  return fields;
}

}  // namespace

const std::string& FilledServicePage() {
  static const std::string page =
      FillPage(ServicePage(), {{"@NAMES@", ParameterNamesJson()}, {"@FLAGS@", FieldsJson()}});
  return page;
}

std::string OpenApiDocument() {
  // References in the schema point to its own definitions; they must work inside the document.
  std::string schema(ResultSchema());
  constexpr std::string_view kOwn = "\"#/$defs/", kInDocument = "\"#/components/schemas/Result/$defs/";
  for (std::size_t at = 0; (at = schema.find(kOwn, at)) != std::string::npos; at += kInDocument.size()) {
    schema.replace(at, kOwn.size(), kInDocument);
  }
  auto result = nlohmann::ordered_json::parse(schema);
  result.erase("$schema");
  result.erase("$id");
  auto document = nlohmann::ordered_json::parse(OpenApiTemplate());
  document["components"]["schemas"]["Result"] = std::move(result);
  AddRunFlags(document);
  document["components"]["schemas"]["GravityName"]["enum"] = GravityModels::kNames;
  document["info"]["version"] = kVersion;
  constexpr int kIndent = 2;
  return document.dump(kIndent) + "\n";
}

}  // namespace pendulum
