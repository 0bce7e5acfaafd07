// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/recording/calibration/calibrate.h"

namespace pendulum {

/// A gnuplot script that writes the calibration as SVG to standard output: points and curve above, residuals below,
/// with ± half a count as dashed lines. It contains the data, opens no file, and has only numbers and fixed texts.
/// `fit` must be the fit of `table`.
std::string CalibrationPlot(const CalibrationTable& table, const CalibrationFit& fit);

}  // namespace pendulum
