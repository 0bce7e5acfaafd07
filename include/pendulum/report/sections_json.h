// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The sections of the text as JSON, for the page: every fit in full. An array of {"id", "title", "law" and "recording"
/// (null: all), "remark", "blocks"}; the id is the title in lower case with hyphens. A block is one of
/// {"kind": "words", "text", "emphasis"}, {"kind": "facts", "rows": [{"name", "text", "emphasis"}]}, {"kind": "table",
/// "columns": [{"header", "is_number", "joins"}], "rows": [[text]], "caution", "rows_before", "left_out"}, {"kind":
/// "formula", "text"}, {"kind": "items", "texts", "emphasis"}. emphasis: "none", "caution" or "alarm". `joins`: the
/// cell belongs to the one before, as an error to its value. Texts are printable, without no-break spaces.
nlohmann::ordered_json SectionsJson(const Sections& sections);

/// The sections of an identification.
nlohmann::ordered_json SectionsJson(const Identification& identification);

/// The same as one line of UTF-8 text.
std::string ToSectionsJsonText(const Identification& identification);

}  // namespace pendulum
