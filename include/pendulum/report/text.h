// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"
#include "pendulum/report/section_text.h"

namespace pendulum {

/// The result as sections: data and sampling, the comparison of several models, each fit and the constancy of its
/// parameters, closed forms and their check, turning points, warnings. kMain: in a comparison one fit is shown in full
/// (Identification::IsShownInFull), and only the parameters of the others. kAll: every fit is, and its sections name
/// it.
Sections ReportSections(const Identification& identification, FitsInFull which = FitsInFull::kMain);

/// All of the result as UTF-8 text for a terminal of 80 columns, in the layout of lmfit's fit_report. Since a terminal
/// shows the end of a text, the sections come in reverse order, and the warnings and the summary last.
std::string ToText(const Identification& identification, TextStyle style = {});

}  // namespace pendulum
