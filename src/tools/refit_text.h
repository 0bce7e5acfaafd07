// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/compare_stores.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// The content of a store as text: runs, fits by model and status, failures by reason.
Result<std::string> StatusText(Store& store);

/// The differences between two stores as text.
std::string ComparisonText(const StoreComparison& comparison, const std::string& before, const std::string& after);

}  // namespace pendulum
