// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/uncertainty/open_interval.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {

/// The likelihood with one parameter held at a value (the problem's units) and the others at their best.
struct ProfilePoint {
  double value = 0;
  /// 2 (log L of the estimate - log L), at least 0, times the variance that the likelihood has at fixed σ over that of
  /// ComputeErrors: for a parabola ((value - estimate) / standard error)².
  double statistic = 0;
};

/// An interval in the problem's units.
struct ProfileInterval {
  std::optional<double> lower;
  std::optional<double> upper;
  OpenInterval open = OpenInterval::kClosed;
  std::vector<ProfilePoint> points;  ///< Values increasing, the estimate among them; empty where there is no interval.
  double threshold = 0;              ///< Of the statistic at the ends: Student's t².
};

/// The errors of a fit when the free parameters are those of that optimum.
using ErrorsOf = std::function<Errors(const Optimum&)>;

/// The 95 % profile-likelihood interval of parameter k, free or at its bound (D. J. Venzon and S. H. Moolgavkar,
/// Applied Statistics 37:87, 1988), with regard to residuals that remember (R. E. Chandler and S. Bate, Biometrika
/// 94:167, 2007). An end beyond a bound is the bound. Its points are spread evenly over the interval, four or more on a
/// side that has a length. samples: of all recordings. Cost: about ten solves.
ProfileInterval ProfileParameter(LeastSquares& cost, const SolveOptions& options, const Solution& solution,
                                 const Optimum& optimum, const ErrorsOf& errors_of, double samples, int k);

/// Of one recording.
ProfileInterval ProfileParameter(TrajectoryCost& cost, const FitProblem& problem, const Solution& solution,
                                 const Optimum& optimum, const Autocorrelation& correlation, int k);

}  // namespace pendulum
