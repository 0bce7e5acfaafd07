// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// The counts of a summary (summary.schema.json): members "models" (fits by model and status), "recommendations" and
/// "failures". Failures are grouped by reason without file names, and without numbers if these differ. Errors as the
/// store.
Result<nlohmann::ordered_json> Overview(Store& store);

}  // namespace pendulum
