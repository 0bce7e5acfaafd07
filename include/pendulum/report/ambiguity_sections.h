// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// What one free swing cannot tell of fit `fit`, and the verdict on the rig's inertia; empty for a fit that did not
/// converge.
Sections AmbiguitySections(const Identification& identification, std::size_t fit);

/// Adds `rig_verdict` and `ambiguities` to the JSON of fit `fit`, each only if there is one.
void AddAmbiguities(const Identification& identification, std::size_t fit, nlohmann::ordered_json& json);

}  // namespace pendulum
