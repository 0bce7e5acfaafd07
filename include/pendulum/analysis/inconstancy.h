// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/constancy.h"
#include "pendulum/fitting/fit/fit.h"

namespace pendulum {

/// Counts what is not constant: the standard error of a parameter that is no constant of its recording says how well
/// one value for all of it is known, and not by how much the next window or run will differ. Where its windows (its
/// halves, where windows have no estimates of it) scatter by more than their errors, or follow the amplitude, at
/// kNotConstant, their standard deviation about its estimate beyond their errors (MODEL.md section 9) is added in
/// squares to its systematic error in `fit`, with the warning not_constant. Several recordings fitted together have the
/// scatter between them instead (RandomEffects).
void CountInconstancy(const Constancy& constancy, FitReport& fit);

}  // namespace pendulum
