// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// The counts of a summary (summary.schema.json): members "models" (fits by model and status), "recommendations" and
/// "failures". Failures are grouped by their reasons without file names and numbers. The reason of a group has the
/// numbers only if they are the same in all its failures. Errors: of the store.
Result<nlohmann::ordered_json> Overview(Store& store);

}  // namespace pendulum
