// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/report/result_summary.h"
#include "pendulum/report/section.h"
#include "pendulum/report/section_text.h"

namespace pendulum {

/// The summary as a section, with all its lines.
Section SummarySection(const ResultSummary& summary);

/// The summary as text for a terminal, in at most 20 lines of 80 columns besides those of a comparison of laws. If
/// there are more, it says the same in fewer lines: parameters of the sensor share a line, then warnings, remarks and
/// derived quantities share paragraphs. At last warnings that are not serious are only named, and the equation, the
/// reasons of the textbook's values, these values and the shares of the losses are left out. `more`: a last line that
/// says where to find more.
std::string SummaryText(const ResultSummary& summary, const std::string& more, TextStyle style = {});

}  // namespace pendulum
