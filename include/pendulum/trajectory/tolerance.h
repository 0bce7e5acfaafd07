// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum {

/// Local tolerance [rad] at which a trajectory of this amplitude [rad] stays within `max_error` [rad] of the truth.
///
/// An error of one step shifts the energy and so the period, the more the nearer the amplitude is to π. Over 46
/// undamped small-angle periods the global error was at most 60 + 1500 tan²(A/2) local tolerances, A from 1 to 179.9
/// deg (tests/trajectory/tolerance_test.cc measures it again). Not below 1e-17, where rounding takes over.
double TraceTolerance(double max_error, double amplitude);

}  // namespace pendulum
