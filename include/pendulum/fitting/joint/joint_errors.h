// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "pendulum/fitting/joint/joint_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// What the errors of rig, clocks and calibrations leave open, P x P in units of G: a source that recordings have in
/// common moves all of them together. Zero where the optimum is not identifiable.
Eigen::MatrixXd SystematicErrors(const JointProblem& joint, const Solution& solution, const Optimum& optimum);

/// Whether the fit to a recording alone rests on a posterior, and all of them have errors.
bool HasPosteriors(const JointProblem& joint);

/// Combines the posteriors of the fits alone as parabolas, into solution, members and the known optimum: quiet
/// recordings have no other likelihood that is one. False, and nothing changed, where they tell too little.
bool UsePosteriors(JointProblem& joint, Solution& solution, Optimum& known);

}  // namespace pendulum
