// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"
#include "pendulum/report/section_text.h"

namespace pendulum {

/// The result for people, section by section: data and sampling, the comparison of several models, each fit and whether
/// its parameters are constants, closed forms and the check of the fit against them, turning points, warnings. In a
/// comparison one fit is given in full (Identification::IsShownInFull), the parameters of the others.
Sections ReportSections(const Identification& report);

/// ReportSections as UTF-8 text for a terminal of 80 columns, in the layout lmfit's fit_report made customary.
std::string ToText(const Identification& report, TextStyle style = {});

}  // namespace pendulum
