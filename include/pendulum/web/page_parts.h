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

/// The symbol of each parameter and what pages call it: {"inertia": {"symbol": "I_O", "words": "moment of inertia",
/// "unit_over_g": "s^2"}, ...}. unit_over_g: the unit of its ratio to the gravity torque, which a fit without a rig
/// has.
nlohmann::ordered_json ParameterNamesJson();

/// JSON escaped so that no string in it can end a script element.
std::string ScriptText(const nlohmann::ordered_json& json);

/// Replaces the tokens of a page by their content. Each token occurs once, in the order of the parts. Inserted text is
/// not searched for tokens.
std::string FillPage(std::string_view page, std::initializer_list<PagePart> parts);

}  // namespace pendulum
