// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/identify/identification.h"

namespace pendulum {

/// Parts of the result's JSON common to fits of one and of several recordings. Missing numbers are null, and `reason`
/// in the same object says why.

/// Spacing of the sensor's levels; null if there are none.
nlohmann::ordered_json ResolutionJson(const DataSummary& data);

/// Estimates by name, each with its errors, unit and flags.
nlohmann::ordered_json ParametersJson(const FitReport& fit);

nlohmann::ordered_json DerivedJson(const FitReport& fit);

/// Names of the free parameters, and a matrix with a row and a column for each, in products of their units.
nlohmann::ordered_json CovarianceJson(const FitReport& fit);
nlohmann::ordered_json CorrelationJson(const FitReport& fit);
nlohmann::ordered_json SystematicJson(const FitReport& fit);

nlohmann::ordered_json NoiseJson(const FitReport& fit, const DataSummary& data);
nlohmann::ordered_json StatisticsJson(const FitReport& fit);
nlohmann::ordered_json IdentifiabilityJson(const FitReport& fit);

/// What the solver did, and the further attempts.
nlohmann::ordered_json SolverJson(const SolverSummary& solver);

}  // namespace pendulum
