// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/joint/joint_problem.h"

namespace pendulum {

/// The joint optimum within the bounds and its information (P x P), if each member's log-likelihood is a parabola
/// around its own fit.
struct CombinedParabolas {
  std::vector<double> parameters;
  Eigen::MatrixXd information;
};
CombinedParabolas CombineParabolas(const JointProblem& joint);

}  // namespace pendulum
