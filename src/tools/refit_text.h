// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/batch/compare_stores.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// What a store holds, for people: runs, fits by model and status, failures by reason.
Result<std::string> StatusText(Store& store);

/// How two stores differ, for people.
std::string ComparisonText(const StoreComparison& comparison, const std::string& before, const std::string& after);

}  // namespace pendulum
