// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

/// Local tolerance [rad] at which a trajectory of this amplitude [rad] stays within `max_error` [rad] of the exact
/// solution, over 46 undamped small-angle periods. At least 1e-17, below which rounding dominates.
double TraceTolerance(double max_error, double amplitude);

}  // namespace pendulum
