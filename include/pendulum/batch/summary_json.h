// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "pendulum/batch/store_summary.h"

namespace pendulum {

/// A summary as JSON (summary.schema.json).
nlohmann::ordered_json ToJson(const StoreSummary& summary);

}  // namespace pendulum
