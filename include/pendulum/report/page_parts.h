// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace pendulum {

/// A place in a page and the JSON that belongs there.
struct PagePart {
  std::string_view token;  ///< "@RESULT@"
  nlohmann::ordered_json content;
};

/// JSON that ends no script element, whatever strings are in it.
std::string ScriptText(const nlohmann::ordered_json& json);

/// A page with its parts put in. The tokens stand in the page in the order of the parts, each once; what is put in is
/// not searched for them.
std::string FillPage(std::string_view page, std::initializer_list<PagePart> parts);

}  // namespace pendulum
