// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A gnuplot script that plots a fit in ASCII, 79 columns and 23 lines, to standard output: measured readings (dots)
/// and fitted ones (stars) above, residuals below; angles and rates in degrees. For each column all values between its
/// smallest and its largest reading are plotted, so that no swing is lost in long recordings. The script contains the
/// data, opens no file, and has only numbers and fixed texts. `used` are the samples of `fit`; without fitted readings
/// only the measured ones are plotted.
std::string TerminalPlot(const Recording& used, const FitReport& fit);

/// The output of gnuplot without form feeds, trailing blanks and empty lines.
std::string PictureText(const std::string& drawn);

}  // namespace pendulum
