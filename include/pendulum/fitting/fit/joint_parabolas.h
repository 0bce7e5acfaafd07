// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/fit/joint_problem.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {

/// The joint optimum within the bounds and its information (P x P), if each member's log-likelihood is a parabola
/// around its own fit.
struct CombinedParabolas {
  std::vector<double> parameters;
  Eigen::MatrixXd information;
};
CombinedParabolas CombineParabolas(const JointProblem& joint);

/// Whether at least one of the separate fits uses a posterior, and all of them have errors.
bool HasPosteriors(const JointProblem& joint);

/// Combines the posteriors of the separate fits as parabolas and stores the result in the solution, the members and
/// `known`. Recordings with very small noise have no other usable likelihood. Returns false, without changes, if the
/// combination is not identifiable.
bool UsePosteriors(JointProblem& joint, Solution& solution, Optimum& known);

}  // namespace pendulum
