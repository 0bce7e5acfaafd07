// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/joint/joint_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// Covariance of the estimates caused by the errors of rig, clocks and calibrations, P x P in units of the restoring
/// torque G. A source shared by several recordings affects all of them together. 0 if the optimum is not identifiable.
Eigen::MatrixXd SystematicErrors(const JointProblem& joint, const Solution& solution, const Optimum& optimum);

/// Whether at least one of the separate fits uses a posterior, and all of them have errors.
bool HasPosteriors(const JointProblem& joint);

/// Combines the posteriors of the separate fits as parabolas and stores the result in the solution, the members and
/// `known`. Recordings with very small noise have no other usable likelihood. Returns false, without changes, if the
/// combination is not identifiable.
bool UsePosteriors(JointProblem& joint, Solution& solution, Optimum& known);

}  // namespace pendulum
