// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Samples begin..begin + size - 1 of a recording, one an interval of its clock.
struct Stretch {
  Eigen::Index begin = 0;
  Eigen::Index size = 0;
};

/// Reflection coefficients of orders 1, 2, ... of the autoregression that predicts the samples of all stretches best
/// from those before and from those after them (Burg, Maximum entropy spectral analysis, Stanford, 1975).
///
/// value      N x 1, of mean 0.
/// stretches  within 0..N - 1; no sample predicts one of another stretch.
/// Returns at most `longest` coefficients, each in (-1, 1), so that the process they make is stationary; fewer when
/// fewer of them leave nothing to predict. Costs O(N longest).
std::vector<double> ReflectionCoefficients(const Eigen::VectorXd& value, const std::vector<Stretch>& stretches,
                                           int longest);

/// The φ of an autoregression with these reflection coefficients (Levinson 1947, Durbin 1960).
std::vector<double> FromReflection(const std::vector<double>& reflection);

}  // namespace pendulum
