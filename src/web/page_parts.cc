// SPDX-License-Identifier: Apache-2.0
#include "pendulum/web/page_parts.h"

#include <cstddef>

#include "pendulum/base/json.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

nlohmann::ordered_json ParameterNamesJson() {
  nlohmann::ordered_json names = nlohmann::ordered_json::object();
  for (const ParameterInfo& info : AllParameters()) {
    nlohmann::ordered_json& one = names[std::string(info.name)];
    one = {{"symbol", info.symbol}, {"words", info.words}};
    if (info.scales_with_gravity()) one["unit_over_g"] = info.relative_unit;
  }
  return names;
}

std::string ScriptText(const nlohmann::ordered_json& json) {
  const std::string text = JsonText(json);
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

std::string FillPage(std::string_view page, std::initializer_list<PagePart> parts) {
  std::string html;
  std::size_t from = 0;
  for (const auto& [token, content] : parts) {
    const std::size_t at = page.find(token, from);
    html += page.substr(from, at - from);
    html += ScriptText(content);
    from = at + token.size();
  }
  html += page.substr(from);
  return html;
}

}  // namespace pendulum
