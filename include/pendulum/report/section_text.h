// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/report/section.h"

namespace pendulum {

struct TextStyle {
  bool colour = false;  ///< With ANSI sequences: headings bold, cautions yellow, alarms red. For terminals only.
};

/// Sections as UTF-8 text in at most kTextWidth columns: "[[title]] (remark)", below it everything by kTextIndent. A
/// table that is wider goes on below itself, each part with the first column. Only a word, a number or a file name
/// that is longer than a line makes a longer one.
std::string ToText(const Sections& sections, TextStyle style = {});

}  // namespace pendulum
