// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/fitting/optimum.h"

namespace pendulum {

/// An interval in the problem's units; `open` says why an end is missing, and is empty when none is.
struct ProfileInterval {
  std::optional<double> lower;
  std::optional<double> upper;
  std::string open;
};

/// The 95 % profile-likelihood interval of parameter k, free or at its bound (D. J. Venzon and S. H. Moolgavkar,
/// Applied Statistics 37:87, 1988), with regard to residuals that remember (R. E. Chandler and S. Bate, Biometrika
/// 94:167, 2007). An end beyond a bound is the bound. Cost: about six solves.
ProfileInterval ProfileParameter(TrajectoryCost& cost, const FitProblem& problem, const Solution& solution,
                                 const Optimum& optimum, const Autocorrelation& correlation, int k);

}  // namespace pendulum
