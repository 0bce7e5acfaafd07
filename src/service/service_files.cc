// SPDX-License-Identifier: Apache-2.0
#include "service/service_files.h"

#include <array>
#include <cstddef>
#include <utility>

#include <nlohmann/json.hpp>

#include "pendulum/base/version.h"

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
  document["info"]["version"] = kVersion;
  constexpr int kIndent = 2;
  return document.dump(kIndent) + "\n";
}

}  // namespace pendulum
