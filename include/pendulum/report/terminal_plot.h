// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A script that makes gnuplot draw a fit in ASCII, 79 columns and 23 lines, to its standard output: measured readings
/// (dots) against fitted ones (stars) above, residuals below; angles and rates in degrees. Of each column's samples the
/// smallest and the largest reading are drawn and what lies between them, so that no swing is lost however many there
/// are. The script holds the data, opens no file and contains nothing but numbers and our own words.
/// `used` are the samples of `fit`; of a fit that has no fitted readings the measured ones are drawn alone.
std::string TerminalPlot(const Recording& used, const FitReport& fit);

/// What gnuplot drew, as text for a terminal: without its form feeds, blanks at ends of lines and empty lines.
std::string PictureText(const std::string& drawn);

}  // namespace pendulum
