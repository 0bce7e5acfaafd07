// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/recording/calibration/calibrate.h"

namespace pendulum {

/// A script that makes gnuplot write the calibration as SVG to its standard output: points and curve above, residuals
/// below, with ± half a count as dashed lines. It holds the data, opens no file and contains nothing but numbers and
/// our own words. `fit` is that of `table`.
std::string CalibrationPlot(const CalibrationTable& table, const CalibrationFit& fit);

}  // namespace pendulum
