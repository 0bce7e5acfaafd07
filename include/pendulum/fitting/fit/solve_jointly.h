// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit/joint_problem.h"

namespace pendulum {

/// Estimates parameters and the σ of each recording in turn. Ends when the remaining step is below a hundredth of a
/// standard error and trajectories are accurate. Sets the members' solutions.
Solution SolveJointly(JointProblem& joint);

}  // namespace pendulum
