// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/report/run_report.h"

namespace pendulum {

/// The result for people: UTF-8 text in the layout lmfit's fit_report made customary, about 100 columns wide. Numbers
/// are rounded by PdgRounding, intervals to the decimal of their value; angles and rates are given in degrees too. Of
/// the correlations, those of at least 0.1 are listed, the largest first. Data and sampling, each fit, closed forms and
/// the check of each fit against them, turning points, warnings.
std::string ToText(const RunReport& report);

}  // namespace pendulum
