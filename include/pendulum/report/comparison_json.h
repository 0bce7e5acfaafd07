// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/analysis/constancy.h"
#include "pendulum/identify/identification.h"

namespace pendulum {

/// "comparison" of the result; null without one.
nlohmann::ordered_json ComparisonJson(const Identification& identification);

/// "constancy" of a fit: its two tests; null if neither could be made.
nlohmann::ordered_json ConstancyJson(const Constancy* constancy);

/// Why ConstancyJson of a fit is null; otherwise empty.
std::string NoConstancyReason(const FitReport& fit, const Constancy* constancy);

}  // namespace pendulum
