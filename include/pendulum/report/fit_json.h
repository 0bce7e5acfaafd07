// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/identify/identification.h"

namespace pendulum {

/// Parts of the result's JSON that a fit of one recording and one of several have alike; numbers that do not exist are
/// null, and `reason` beside them says why.

/// [lower, upper], null where there is neither.
nlohmann::ordered_json IntervalJson(const std::optional<double>& lower, const std::optional<double>& upper);

/// Spacing of the sensor's levels, null where there are none.
nlohmann::ordered_json ResolutionJson(const DataSummary& data);

/// Estimates by name, each with its errors, unit and flags.
nlohmann::ordered_json ParametersJson(const FitReport& fit);

nlohmann::ordered_json DerivedJson(const FitReport& fit);

/// Of the free parameters: names and matrix, in products of their units.
nlohmann::ordered_json CovarianceJson(const FitReport& fit);
nlohmann::ordered_json CorrelationJson(const FitReport& fit);
nlohmann::ordered_json SystematicJson(const FitReport& fit);

nlohmann::ordered_json NoiseJson(const FitReport& fit, const DataSummary& data);
nlohmann::ordered_json StatisticsJson(const FitReport& fit);
nlohmann::ordered_json IdentifiabilityJson(const FitReport& fit);

}  // namespace pendulum
