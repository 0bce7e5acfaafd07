// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {

/// A calibration as text: curve, coefficients ± standard errors (PdgRounding) and their correlations, the points with
/// residuals (of more than kShownPoints points, those with the largest residuals), and an interpretation. UTF-8, about
/// 100 columns. `fit` must be the fit of `table`.
/// kSummary: without points, correlations and the errors of extrapolation.
std::string CalibrationText(const CalibrationTable& table, const CalibrationFit& fit,
                            TextExtent extent = TextExtent::kAll);

/// The maximal number of points in CalibrationText.
inline constexpr int kShownPoints = 50;

}  // namespace pendulum
