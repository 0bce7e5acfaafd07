// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/tolerance.h"

#include <algorithm>
#include <cmath>

namespace pendulum {

/// An error of one step shifts the energy and so the period, the more the nearer the amplitude is to π. Over 46
/// undamped small-angle periods the global error was at most 400 + 10000 tan²(A/2) local tolerances, A from 1 to 179.9
/// deg (tests/trajectory/tolerance_test.cc measures it again).
double TraceTolerance(double max_error, double amplitude) {
  const double tangent = std::tan(0.5 * std::min(std::abs(amplitude), 3.14));
  return std::max(max_error / (400 + 10000 * tangent * tangent), 1e-17);
}

}  // namespace pendulum
