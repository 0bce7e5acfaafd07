// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/tolerance.h"

#include <algorithm>
#include <cmath>

namespace pendulum {

double TraceTolerance(double max_error, double amplitude) {
  const double tangent = std::tan(0.5 * std::min(std::abs(amplitude), 3.14));
  return std::max(max_error / (60 + 1500 * tangent * tangent), 1e-17);
}

}  // namespace pendulum
