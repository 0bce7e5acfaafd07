// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace pendulum {

/// Adds to a JSON object with "estimate", "std_error", "unit" and perhaps "total_std_error" the texts that pages show:
/// "text", "0.0790 ± 0.0028", the value with its total error (else its standard error); null without a value. An angle
/// or a rate has the same in degrees: "text_in_degrees".
void AddTexts(nlohmann::ordered_json& estimate);

/// Adds these texts to all parameters of a result. Results of earlier versions have none.
void AddTextsOfParameters(nlohmann::ordered_json& result);

}  // namespace pendulum
