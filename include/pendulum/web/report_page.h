// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/identify/identification.h"

namespace pendulum {

/// The report as one HTML file that needs no network: the page built from src/web/report with result, series and the
/// command line (empty for none) embedded as JSON.
std::string ToHtml(const Identification& identification, const std::string& command);

}  // namespace pendulum
