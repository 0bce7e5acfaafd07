// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/report/section.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {

struct TextStyle {
  bool colour = false;     ///< Uses ANSI sequences: headings bold, cautions yellow, alarms red. For terminals only.
  int width = kTextWidth;  ///< Columns of a line.
};

/// Sections as UTF-8 text in at most style.width columns: "[[title]] (remark)", with the content indented by
/// kTextIndent. A wider table continues below, with the first column repeated. Only a word, number or file name longer
/// than a line makes a longer line.
std::string ToText(const Sections& sections, TextStyle style = {});

}  // namespace pendulum
