// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

/// Local tolerance [rad] at which a trajectory of this amplitude [rad] stays within `max_error` [rad] of the truth,
/// over 46 undamped small-angle periods. Not below 1e-17, where rounding takes over.
double TraceTolerance(double max_error, double amplitude);

}  // namespace pendulum
