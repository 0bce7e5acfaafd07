// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/rig.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// One fit: model and status, parameters, derived quantities, correlations, noise and statistics, equation of motion.
/// Numbers are rounded by PdgRounding, intervals to the decimal of their value; angles and rates are also given in
/// degrees. Correlations of at least 0.1 are listed, the largest first. `check`: the check of this fit, or nullptr.
Sections FitSections(const FitReport& fit, const std::optional<Rig>& rig, const ClosedFormCheck* check);

/// Parts of FitSections, also used for joint fits: parameters with all their properties, derived quantities,
/// correlations, the equation with its numbers.
Section AllOfParameters(const FitReport& fit, const std::optional<Rig>& rig, const ClosedFormCheck* check);
Section DerivedSection(const FitReport& fit);
Section CorrelationSection(const FitReport& fit);
Section EquationSection(const FitReport& fit, const std::optional<Rig>& rig);

/// "gaussian, sigma 0.00346 ± 0.00006 rad (0.198 deg, 1 resolutions)".
std::string NoiseText(const FitReport& fit);

/// The table of estimates alone, with the status of a fit that did not converge: "Parameters of drag".
Section ParameterSection(const FitReport& fit, bool is_one_of_several);

/// An equation with line breaks only before +, - and =: the other blanks become no-break spaces.
std::string WithUnbrokenTerms(const std::string& equation);

}  // namespace pendulum
