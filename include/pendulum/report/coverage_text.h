// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pendulum/analysis/coverage.h"

namespace pendulum {

/// The studies as tables in plain text, a line for each parameter of each scenario, then one for each scenario:
///
///   coverage            of the 95 % intervals, with its own 95 % interval
///   rms error           of the estimates, in the parameter's unit
///   error/bound         rms error over the Cramér-Rao bound; - where there is none
///   std error/error     mean standard error over rms error; - where there is none
///   no interval         recordings without an interval; they count as not covered
///   verdict             pass, or what misses the scenario's rule: "coverage", "error"
std::string CoverageText(std::span<const CoverageStudy> studies);

/// The same as a page of Markdown, which says what the columns are and gives the command that made it.
std::string CoverageMarkdown(std::span<const CoverageStudy> studies, std::string_view command);

/// Name and description of each scenario, a line each.
std::string CoverageScenarioList(std::span<const CoverageScenario> scenarios);

}  // namespace pendulum
