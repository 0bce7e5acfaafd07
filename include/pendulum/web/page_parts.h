// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace pendulum {

/// A token in a page and its JSON replacement.
struct PagePart {
  std::string_view token;  ///< "@RESULT@"
  nlohmann::ordered_json content;
};

/// JSON escaped so that no string in it can end a script element.
std::string ScriptText(const nlohmann::ordered_json& json);

/// Replaces the tokens of a page by their content. Each token occurs once, in the order of the parts. Inserted text is
/// not searched for tokens.
std::string FillPage(std::string_view page, std::initializer_list<PagePart> parts);

}  // namespace pendulum
