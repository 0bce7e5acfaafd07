// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/identify/identification.h"

namespace pendulum {

/// The result as a JSON object. result.schema.json, in the same folder, describes every key. Values are SI and have
/// their unit next to them; residuals, noise and resolution have the suffix _rad_s for a rate and _rad for an angle.
/// Strict JSON: a missing number is null, and `reason` in the same object says why. It has no samples, clock times,
/// computing times or command, so the same recording and flags give the same bytes.
nlohmann::ordered_json ToJson(const Identification& identification);

/// ToJson as UTF-8 text, indented by two blanks, with a line break at its end. Invalid UTF-8 becomes U+FFFD.
std::string ToJsonText(const Identification& identification);

}  // namespace pendulum
