// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"
#include "pendulum/fitting/uncertainty/open_interval.h"

namespace pendulum {

/// The likelihood with one parameter held at a value (the problem's units) and the other parameters at their optimum.
struct ProfilePoint {
  double value = 0;
  /// 2 (log L of the estimate - log L), at least 0, times a ratio of variances: the variance of the likelihood at fixed
  /// σ divided by the variance of ComputeErrors. For a parabola it is ((value - estimate) / standard error)².
  double statistic = 0;
};

/// An interval in the problem's units.
struct ProfileInterval {
  std::optional<double> lower;
  std::optional<double> upper;
  OpenInterval open = OpenInterval::kClosed;
  std::vector<ProfilePoint> points;  ///< Increasing values, the estimate among them; empty without an interval.
  double threshold = 0;              ///< Value of the statistic at the ends: Student's t².
};

/// The 95 % profile-likelihood interval of parameter k, which is free or at its bound (D. J. Venzon and S. H.
/// Moolgavkar, Applied Statistics 37:87, 1988). It accounts for autocorrelated residuals (R. E. Chandler and S. Bate,
/// Biometrika 94:167, 2007). An end beyond a bound is set to the bound. The points are spread evenly over the interval,
/// at least four on each side of nonzero length. Cost: about ten solves.
ProfileInterval ProfileParameter(const SolvedFit& fit, const Optimum& optimum, int k);

}  // namespace pendulum
