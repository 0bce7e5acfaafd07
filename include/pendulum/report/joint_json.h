// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "pendulum/identify/identification.h"

namespace pendulum {

/// Fit `index` of a joint report: shared parameters in `parameters`, each recording's own numbers in `runs`, the
/// agreement of the recordings in `homogeneity` ($defs/joint_fit of the schema).
nlohmann::ordered_json JointFitJson(const Identification& identification, std::size_t index);

}  // namespace pendulum
