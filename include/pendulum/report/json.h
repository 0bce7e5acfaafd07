// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/identify/identification.h"

namespace pendulum {

/// The result as a JSON object: result.schema.json, beside this header, describes it key by key. Values are SI with
/// their unit beside them; a rate's residuals, noise and resolution carry the suffix _rad_s where an angle's carry
/// _rad. Strict JSON: a number that does not exist is null, and `reason` in the same object says why. It holds no
/// samples, clock times, durations of computing or command: the same recording and flags give the same bytes.
nlohmann::ordered_json ToJson(const Identification& report);

/// ToJson as UTF-8 text, indented by two blanks, with a line break at its end. Bytes that are not UTF-8 become U+FFFD.
std::string ToJsonText(const Identification& report);

}  // namespace pendulum
