// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// Fit `index`: model and status, parameters, agreement of several recordings and what each has for itself, derived
/// quantities, correlations, noise and statistics, equation of motion, constancy, what the residuals suggest. Numbers
/// are rounded by PdgRounding, intervals to the decimal of their value; angles and rates are also given in degrees.
/// Correlations of at least 0.1 are listed, the largest first.
Sections FitSections(const Identification& identification, std::size_t index);

/// The table of estimates alone, with the status of a fit that did not converge: "Parameters of drag".
Section ParameterSection(const FitReport& fit, bool is_one_of_several);

/// An equation with line breaks only before +, - and =: the other blanks become no-break spaces.
std::string WithUnbrokenTerms(const std::string& equation);

}  // namespace pendulum
