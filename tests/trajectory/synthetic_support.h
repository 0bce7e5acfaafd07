// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of synthetic recordings.
#pragma once

#include <numeric>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/trajectory/synthetic.h"

namespace pendulum {

// Rig of the activity "Modeling of a Simple Pendulum" (Control Tutorials for MATLAB and Simulink): G = (M + m/2) g l
// with M 0.380 kg, m 0.095 kg, l 0.43 m, g 9.81 m/s².
inline constexpr double kTextbookGravityTorque = (0.380 + 0.095 / 2) * 9.81 * 0.43;  // N m

/// The published fit of that rig: I_O 0.079 kg m², b 0.003 N m s/rad, released at 1.9 s from 24.23 deg.
inline SyntheticOptions TextbookRig() {
  SyntheticOptions options;
  options.model = {"viscous", "viscous", Gravity::kSine};
  options.parameters = {0.079 / kTextbookGravityTorque, 0.003 / kTextbookGravityTorque};
  options.release_angle = 0.423;
  options.release_time = 1.9;
  return options;
}

inline std::vector<double> Deviations(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::VectorXd difference = x - y;
  return {difference.begin(), difference.end()};
}

/// Checks that Σ x² / σ² lies in the chi-square interval that excludes one seed in a million.
inline void ExpectStandardDeviation(const std::vector<double>& x, double sigma) {
  const boost::math::chi_squared distribution(static_cast<double>(x.size()));
  const double statistic = std::inner_product(x.begin(), x.end(), x.begin(), 0.0) / (sigma * sigma);
  EXPECT_THAT(statistic, testing::AllOf(testing::Ge(quantile(distribution, 5e-7)),
                                        testing::Le(quantile(complement(distribution, 5e-7)))));
}

}  // namespace pendulum
