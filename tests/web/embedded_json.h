// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace pendulum {

/// The JSON in the script element with this id.
inline nlohmann::ordered_json Embedded(const std::string& html, const std::string& id) {
  const std::size_t element = html.find("id=\"" + id + "\"");
  const std::size_t begin = html.find('>', element) + 1;
  return nlohmann::ordered_json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

}  // namespace pendulum
