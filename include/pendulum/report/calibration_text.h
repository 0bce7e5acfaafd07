// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/rounding.h"
#include "pendulum/recording/calibration/calibrate.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {

/// A coefficient of a calibration as it is shown.
struct CoefficientText {
  std::string name;     ///< "c1".
  ValueAndError value;  ///< With six digits and no error if its error is unknown.
  std::string unit;     ///< "deg/count".
};

/// The coefficients of the fit of `table`, the constant first.
std::vector<CoefficientText> CoefficientTexts(const CalibrationTable& table, const CalibrationFit& fit);

/// A calibration as text: curve, coefficients ± standard errors (PdgRounding) and their correlations, the points with
/// residuals (of more than kShownPoints points, those with the largest residuals), and an interpretation. UTF-8, about
/// 100 columns. `fit` must be the fit of `table`.
/// kSummary: without points, correlations and the errors of extrapolation.
std::string CalibrationText(const CalibrationTable& table, const CalibrationFit& fit,
                            TextExtent extent = TextExtent::kAll);

/// The maximal number of points in CalibrationText.
inline constexpr int kShownPoints = 50;

}  // namespace pendulum
