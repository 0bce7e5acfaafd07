// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/joint_fit.h"
#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// As CompareModels, of joint fits, or where the recordings disagree by the law that describes each of them best, of the
/// fits to each alone, for a joint fit then lacks more than a law: likelihoods are those of all recordings together, with as many parameters as all of
/// them have; where residuals remember, each recording has a memory of its own and what is shared is the likeliest for
/// all. Predictions are those of each recording from parts of itself, together. Residuals of different units have no
/// common rms; a recording's are then divided by its σ.
Comparison CompareJointModels(const JointModels& joint, const FitOptions& options, const CompareOptions& how = {});

}  // namespace pendulum
