// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/report_page.h"

#include <nlohmann/json.hpp>

#include "pendulum/report/json.h"
#include "pendulum/report/sections_json.h"
#include "pendulum/report/series.h"
#include "pendulum/web/page_parts.h"
#include "web/report_page_template.h"

namespace pendulum {

std::string ToHtml(const Identification& identification, const std::string& command) {
  using Json = nlohmann::ordered_json;
  return FillPage(ReportPageTemplate(), {{"@NAMES@", ParameterNamesJson()},
                                         {"@RESULT@", ToJson(identification)},
                                         {"@SECTIONS@", SectionsJson(identification)},
                                         {"@SERIES@", SeriesJson(identification, SeriesDetail::kPage)},
                                         {"@COMMAND@", command.empty() ? Json(nullptr) : Json{{"command", command}}}});
}

}  // namespace pendulum
