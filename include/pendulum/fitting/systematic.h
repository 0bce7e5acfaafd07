// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/optimum.h"

namespace pendulum {

/// What the errors of rig, clock and calibration leave open in the estimates: their covariance, one source after the
/// other (MODEL.md eq. (24) and (31)), P x P in products of the report's units; zero rows for what is fixed.
///
/// estimates: P, in the report's units. The rig's gravity torque is a common factor of inertia and friction; the
/// clock's scale enters by the powers of time in a parameter; the calibration's coefficients move every reading, and
/// the estimates follow as the least squares around the optimum do.
Eigen::MatrixXd SystematicCovariance(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                     const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum,
                                     const Eigen::VectorXd& estimates);

}  // namespace pendulum
