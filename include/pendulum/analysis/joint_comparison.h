// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/joint_fit.h"
#include "pendulum/analysis/model_comparison.h"

namespace pendulum {

/// CompareModels for several recordings. It compares the joint fits. If the recordings disagree under the law that
/// describes each of them best, it compares the fits to each recording alone, because then no law makes the joint fit
/// right. Likelihoods are sums over the recordings. Autocorrelated residuals have a separate autocorrelation for each
/// recording, and the shared parameters are the most likely ones for all recordings. Each recording is predicted from
/// parts of itself. If units differ there is no common rms; the residuals of a recording are then divided by the least
/// σ of any model for this recording.
Comparison CompareJointModels(const JointModels& joint, const FitOptions& options, const CompareOptions& how = {});

}  // namespace pendulum
