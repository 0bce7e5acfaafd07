// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// The part of a summary that counts (summary.schema.json): members "models", fits by model and status,
/// "recommendations" and "failures", these grouped by their reasons without file names, and without numbers where
/// these differ. Errors as the store.
Result<nlohmann::ordered_json> Overview(Store& store);

}  // namespace pendulum
