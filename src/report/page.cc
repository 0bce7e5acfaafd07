// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/page.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "pendulum/report/json.h"
#include "pendulum/report/series.h"
#include "report/page_template.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

/// JSON that ends no script element, whatever strings are in it.
std::string ScriptText(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::string ToHtml(const std::vector<Recording>& used, const RunReport& report, const std::string& command) {
  const std::string_view page = PageTemplate();
  const std::array<std::pair<std::string_view, std::string>, 3> parts = {
      {{"@RESULT@", ScriptText(ToJson(report))},
       {"@SERIES@", ScriptText(SeriesJson(used, report, SeriesDetail::kPage))},
       {"@COMMAND@", ScriptText(command.empty() ? Json(nullptr) : Json{{"command", command}})}}};
  std::string html;
  std::size_t from = 0;
  // The tokens stand in this order; what is put in is not searched.
  for (const auto& [token, text] : parts) {
    const std::size_t at = page.find(token, from);
    html += page.substr(from, at - from);
    html += text;
    from = at + token.size();
  }
  html += page.substr(from);
  return html;
}

}  // namespace pendulum
