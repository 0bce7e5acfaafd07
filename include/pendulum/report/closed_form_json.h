// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/identify/identification.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// "sampling" of the data; null if it is unknown.
nlohmann::ordered_json SamplingJson(const std::optional<Sampling>& sampling);

/// "closed_form" of a fit: one row per quantity; empty if `check` is null.
nlohmann::ordered_json CheckJson(const ClosedFormCheck* check);

/// "closed_forms" of a recording without the turning points (SeriesJson); null if there are none. SI with a rig;
/// otherwise inertia and torques are divided by G.
nlohmann::ordered_json ClosedFormsJson(const IdentifiedRecording& recording, const std::optional<Rig>& si_rig);

}  // namespace pendulum
