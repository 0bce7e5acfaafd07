// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/optimum.h"

namespace pendulum {

/// What the errors of rig, clock and calibration leave open in the estimates: their covariance (MODEL.md eq. (24) and
/// (31)), P x P in products of the report's units; zero rows for what is fixed. estimates: P, in the report's units.
Eigen::MatrixXd SystematicCovariance(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                     const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum);

}  // namespace pendulum
