// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/estimate_texts.h"

#include <string>

#include "pendulum/base/rounding.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {

using Json = nlohmann::ordered_json;

namespace {

/// The number under the key; 0 without one.
double NumberOf(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

void AddTextsOfFits(Json& of_fits) {
  if (!of_fits.contains("fits")) return;
  for (Json& fit : of_fits["fits"]) {
    if (!fit.contains("parameters")) continue;
    for (Json& parameter : fit["parameters"]) AddTexts(parameter);
  }
}

}  // namespace

void AddTexts(Json& estimate) {
  const double value = NumberOf(estimate, "estimate"), total = NumberOf(estimate, "total_std_error");
  const double error = total > 0 ? total : NumberOf(estimate, "std_error");
  const bool has_value = estimate["estimate"].is_number();
  estimate["text"] = has_value ? Json(PlusMinusText(value, error)) : Json(nullptr);
  const auto degrees = Degrees(estimate["unit"].get<std::string>());
  if (degrees && has_value)
    estimate["text_in_degrees"] = PlusMinusText(degrees->factor * value, degrees->factor * error);
}

void AddTextsOfParameters(Json& result) {
  AddTextsOfFits(result);
  if (!result.contains("recordings")) return;
  for (Json& recording : result["recordings"]) AddTextsOfFits(recording);
}

}  // namespace pendulum
