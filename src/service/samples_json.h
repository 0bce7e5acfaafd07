// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "pendulum/recording/recording.h"

namespace pendulum {

/// The samples of a recording as read, thinned to at most `max_shown` for a plot: {"time_s", "measured", "unit",
/// "samples"}; "samples" is the number before thinning.
nlohmann::ordered_json SamplesJson(const Recording& recording, Eigen::Index max_shown);

/// The same, but in degrees (deg or deg/s) if the file is in degrees.
nlohmann::ordered_json SamplesInOwnUnitJson(const Recording& recording, Eigen::Index max_shown);

}  // namespace pendulum
