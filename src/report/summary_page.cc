// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/summary_page.h"

#include "pendulum/report/page_parts.h"
#include "report/summary_page_template.h"

namespace pendulum {

std::string SummaryHtml(const nlohmann::ordered_json& summary) {
  return FillPage(SummaryPageTemplate(), {{"@SUMMARY@", summary}});
}

}  // namespace pendulum
