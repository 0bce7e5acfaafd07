// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/identify/identification.h"

namespace pendulum {

/// The JSON of fits. Missing numbers are null, and `reason` in the same object says why.

/// Fit m: what all recordings share, and what follows from it ($defs/fit of result.schema.json). Missing parts of a
/// failed fit are null; its `reason` says why.
nlohmann::ordered_json FitJson(const Identification& identification, std::size_t m);

/// What fit m says of recording k: its own parameters, the covariance of all its parameters, noise, checks
/// ($defs/recording_fit).
nlohmann::ordered_json RecordingFitJson(const Identification& identification, std::size_t k, std::size_t m);

/// Which parameters of a fit a part shows.
using ShowsParameter = std::function<bool(std::string_view name)>;

inline bool ShowAll(std::string_view /*name*/) { return true; }

/// Estimates by name, each with its errors, unit and flags.
nlohmann::ordered_json ParametersJson(const FitReport& fit, const ShowsParameter& shows = ShowAll);

nlohmann::ordered_json DerivedJson(const FitReport& fit);

/// Names of the free parameters, and a matrix with a row and a column for each, in products of their units.
nlohmann::ordered_json CovarianceJson(const FitReport& fit, const ShowsParameter& shows = ShowAll);
nlohmann::ordered_json CorrelationJson(const FitReport& fit, const ShowsParameter& shows = ShowAll);
nlohmann::ordered_json SystematicJson(const FitReport& fit, const ShowsParameter& shows = ShowAll);

/// Spacing of the sensor's levels; null if there are none.
nlohmann::ordered_json ResolutionJson(const DataSummary& data);

nlohmann::ordered_json NoiseJson(const FitReport& fit, const DataSummary& data);
nlohmann::ordered_json StatisticsJson(const FitReport& fit);
nlohmann::ordered_json IdentifiabilityJson(const FitReport& fit, const ShowsParameter& shows = ShowAll);

/// What the solver did, and the further attempts.
nlohmann::ordered_json SolverJson(const SolverSummary& solver);

}  // namespace pendulum
