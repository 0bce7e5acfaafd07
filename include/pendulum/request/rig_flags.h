// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// A value of the rig with its unit, such as "380g", "43.2+-0.1 cm" or "0.38", in SI. `flag`: for messages.
///
/// kInvalidArgument: not a number, or a unit of another quantity; the message lists the units.
Result<RigValue> ParseRigValue(const std::string& flag, const std::string& text, const RigKey& key);

/// The values of the rig's flags, which are in the order of RigKeys, as members of a rig file. The warning
/// rig_unit_assumed names those without a unit. Errors as ParseRigValue.
Result<nlohmann::ordered_json> RigValuesOf(const std::vector<std::string>& texts, std::vector<Warning>& warnings);

}  // namespace pendulum
