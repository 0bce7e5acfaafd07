// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/joint/joint_problem.h"

namespace pendulum {

/// Solves, σ of each recording in turn with the parameters, until a step below a hundredth of a standard error is left
/// to make and trajectories are accurate. The members' solutions are set.
Solution SolveJointly(JointProblem& joint);

}  // namespace pendulum
