// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/analysis/constancy.h"
#include "pendulum/fitting/fit.h"

namespace pendulum {

/// Counts what is not constant where parameters are no constants of their recording: their standard errors say how well
/// one value for all of it is known, and not by how much the next window or run will differ. The standard deviation
/// between windows (between halves, where there are no windows) beyond their own errors, MODEL.md eq. (60), is added in
/// squares to the systematic errors of `fit`, with the warning not_constant. Nothing where `constancy` is constant.
void CountInconstancy(const Constancy& constancy, FitReport& fit);

}  // namespace pendulum
