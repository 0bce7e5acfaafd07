// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <random>

#include "pendulum/model/series.h"

namespace pendulum {

/// The given coefficients, followed by NaN to detect reads beyond them.
inline Series<double> Coefficients(std::initializer_list<double> given) {
  Series<double> series;
  series.fill(std::numeric_limits<double>::quiet_NaN());
  std::copy(given.begin(), given.end(), series.begin());
  return series;
}

/// Coefficients that decrease like those of a function with a singularity at 1/decay.
inline Series<double> RandomSeries(std::mt19937_64& generator, double decay) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Series<double> series;
  double scale = 1;
  for (double& c : series) {
    c = scale * uniform(generator);
    scale *= decay;
  }
  return series;
}

}  // namespace pendulum
