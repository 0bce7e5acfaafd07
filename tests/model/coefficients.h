// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>

#include "pendulum/model/series.h"

namespace pendulum {

/// The given coefficients, followed by NaN to detect reads beyond them.
inline Series<double> Coefficients(std::initializer_list<double> given) {
  Series<double> series;
  series.fill(std::numeric_limits<double>::quiet_NaN());
  std::copy(given.begin(), given.end(), series.begin());
  return series;
}

}  // namespace pendulum
