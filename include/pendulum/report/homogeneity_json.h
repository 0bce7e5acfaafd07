// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "pendulum/analysis/homogeneity.h"

namespace pendulum {

/// "homogeneity" of a fit: whether its recordings agree. Recordings are numbered from 1.
nlohmann::ordered_json HomogeneityJson(const Homogeneity& homogeneity);

}  // namespace pendulum
