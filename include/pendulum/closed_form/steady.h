// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Dense>

namespace pendulum {

/// Whether readings show one value: they drift by less than three standard deviations of the noise, and scatter about
/// their line by less than twice the noise. values: at least 2; noise: their standard deviation, in the same unit.
inline bool IsSteady(const Eigen::VectorXd& values, double noise) {
  Eigen::MatrixX2d basis(values.size(), 2);
  basis << Eigen::ArrayXd::Ones(values.size()), Eigen::ArrayXd::LinSpaced(values.size(), 0, 1);
  const Eigen::Vector2d line = basis.colPivHouseholderQr().solve(values);
  const double scatter = (values - basis * line).norm() / std::sqrt(static_cast<double>(values.size()));
  return std::abs(line[1]) < 3 * noise && scatter < 2 * noise;
}

}  // namespace pendulum
