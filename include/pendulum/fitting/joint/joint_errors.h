// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/fitting/joint/joint_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/uncertainty/systematic.h"

namespace pendulum {

/// The covariances that errors of rig, clocks and calibrations cause, P x P in units of the restoring torque G, one for
/// each kind of source that has an error. A source shared by several recordings affects all of them together. Empty if
/// the optimum is not identifiable.
std::vector<SystematicCovariance> JointSystematicCovariances(const JointProblem& joint, const Solution& solution,
                                                             const Optimum& optimum);

/// Whether at least one of the separate fits uses a posterior, and all of them have errors.
bool HasPosteriors(const JointProblem& joint);

/// Combines the posteriors of the separate fits as parabolas and stores the result in the solution, the members and
/// `known`. Recordings with very small noise have no other usable likelihood. Returns false, without changes, if the
/// combination is not identifiable.
bool UsePosteriors(JointProblem& joint, Solution& solution, Optimum& known);

}  // namespace pendulum
