// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/joint_fit.h"
#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// As CompareModels, over several recordings. Compared are the joint fits; where the recordings disagree by the law
/// that describes each of them best, the fits to each alone, for a joint fit then lacks more than a law. Likelihoods
/// are sums over the recordings; where residuals remember, each recording has a memory of its own and what is shared is
/// the likeliest for all. Predictions are those of each recording from parts of itself. Residuals of different units
/// have no common rms: those of a recording are then divided by the least σ of any model there.
Comparison CompareJointModels(const JointModels& joint, const FitOptions& options, const CompareOptions& how = {});

}  // namespace pendulum
