// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pendulum/analysis/coverage.h"

namespace pendulum {

/// The studies as plain-text tables: a line per parameter of each scenario, then a line per scenario. Columns as
/// CoverageRow, "-" for missing values. The verdict is "pass", or the part that violates the rule: "coverage", "error".
std::string CoverageText(std::span<const CoverageStudy> studies);

/// The same as a Markdown page, with a description of the columns and the command that made it.
std::string CoverageMarkdown(std::span<const CoverageStudy> studies, std::string_view command);

/// Name and description of each scenario, one per line.
std::string CoverageScenarioList(std::span<const CoverageScenario> scenarios);

}  // namespace pendulum
