// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/summary_page.h"

#include "pendulum/web/page_parts.h"
#include "web/summary_page_template.h"

namespace pendulum {

std::string SummaryHtml(const nlohmann::ordered_json& summary) {
  return FillPage(SummaryPageTemplate(), {{"@NAMES@", ParameterNamesJson()}, {"@SUMMARY@", summary}});
}

}  // namespace pendulum
