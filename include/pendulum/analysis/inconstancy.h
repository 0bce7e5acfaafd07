// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/constancy.h"
#include "pendulum/fitting/fit/fit.h"

namespace pendulum {

/// Adds the error of parameters that are not constant. The standard error describes one value for the whole recording;
/// it does not include the difference to the next window or run. The error is added if a test with p < kNotConstant
/// shows that the windows scatter by more than their errors, or depend on amplitude. If windows have no estimates, the
/// halves are used. The added error is the standard deviation of the windows about the estimate, beyond their errors
/// (MODEL.md section 9). It is added in quadrature to the systematic error in `fit`, with the warning not_constant.
/// Joint fits use the scatter between recordings instead (RandomEffects).
void AddInconstancyError(const Constancy& constancy, FitReport& fit);

}  // namespace pendulum
