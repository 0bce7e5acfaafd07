// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/recording/calibrate.h"

namespace pendulum {

/// A calibration for people: curve, coefficients ± standard errors (PdgRounding) and their correlations, the points
/// with residuals (all of them, or the kShownPoints with the largest), and what they say of the fit in words. UTF-8,
/// about 100 columns. `fit` is that of `table`.
std::string CalibrationText(const CalibrationTable& table, const CalibrationFit& fit);

/// Points that CalibrationText lists at most.
inline constexpr int kShownPoints = 50;

}  // namespace pendulum
