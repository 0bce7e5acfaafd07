// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The report for a laboratory notebook, as GitHub-flavoured Markdown: the summary first, then the warnings and the
/// other sections of ReportSections. A value and its error share a cell, "0.0790 ± 0.0003".
std::string ToMarkdown(const Identification& identification);

/// Sections as Markdown: a heading of level 2 for each, tables with pipes.
std::string ToMarkdown(const Sections& sections);

/// Escapes a text for a sentence or a table cell, so that Markdown shows it unchanged. Characters that start emphasis,
/// code, a link, HTML, mathematics or a cell are escaped; control characters become "?".
std::string MarkdownText(std::string_view text);

}  // namespace pendulum
