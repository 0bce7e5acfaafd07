// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pendulum/analysis/coverage.h"

namespace pendulum {

/// The studies as tables in plain text: a line for each parameter of each scenario, then one for each scenario. Columns
/// as CoverageRow, "-" for what is absent; the verdict is "pass", or what misses its rule: "coverage", "error".
std::string CoverageText(std::span<const CoverageStudy> studies);

/// The same as a page of Markdown, with what the columns are and the command that made it.
std::string CoverageMarkdown(std::span<const CoverageStudy> studies, std::string_view command);

/// Name and description of each scenario, a line each.
std::string CoverageScenarioList(std::span<const CoverageScenario> scenarios);

}  // namespace pendulum
