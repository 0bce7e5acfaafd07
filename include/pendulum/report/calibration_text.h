// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/recording/calibration/calibrate.h"

namespace pendulum {

/// A calibration for people: curve, coefficients ± standard errors (PdgRounding) and their correlations, the points
/// with residuals (at most the kShownPoints largest), and what they say. UTF-8, about 100 columns. `fit` is of `table`.
std::string CalibrationText(const CalibrationTable& table, const CalibrationFit& fit);

/// Points that CalibrationText lists at most.
inline constexpr int kShownPoints = 50;

}  // namespace pendulum
