// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/report/run_report.h"

namespace pendulum {

/// How the recording was sampled, as a section of ToText; empty when the report does not say.
std::string SamplingText(const RunReport& report);

/// The closed forms, the check of each fit against them, and the table of turning points, as sections of ToText: all
/// turning points of closed forms only (60 at most), beside a fit the first ten and the last two. Empty without these.
std::string ClosedFormText(const RunReport& report);

}  // namespace pendulum
