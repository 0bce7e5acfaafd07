// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The report for a laboratory notebook, as GitHub-flavoured Markdown: the verdict and the parameters first, then the
/// sections of ToText in their order. Values and errors share a cell, "0.0790 ± 0.0003".
std::string ToMarkdown(const Identification& report);

/// Sections as Markdown: a heading of level 2 each, tables with pipes.
std::string ToMarkdown(const Sections& sections);

/// A text that Markdown shows as it is, in a sentence or in a cell of a table: what would begin emphasis, code, a link,
/// HTML, mathematics or a cell is escaped, control characters are "?".
std::string MarkdownText(std::string_view text);

}  // namespace pendulum
