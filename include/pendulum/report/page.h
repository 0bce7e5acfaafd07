// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/recording/recording.h"
#include "pendulum/report/run_report.h"

namespace pendulum {

/// The report as one HTML file that needs no network: the page built from src/report/page with result, series and the
/// command line (empty for none) embedded as JSON. used: the samples of the report, of each recording of a joint fit.
std::string ToHtml(const std::vector<Recording>& used, const RunReport& report, const std::string& command);

}  // namespace pendulum
