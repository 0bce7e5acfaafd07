// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"

namespace pendulum {

/// No rig and no calibration comes near it, and a JSON object looks its keys up one by one.
inline constexpr std::size_t kMostJsonBytes = 65536;

/// Neither rig nor request has more, within one another or in all; what has costs time and stack.
inline constexpr int kMostJsonDepth = 32, kMostJsonKeys = 4096;

/// A JSON object from text, each key of every object once. `kind` is what it should be, "rig"; `form` shows one.
/// kDataLoss: not JSON (line and column), no object, longer than `most_bytes`, deeper than kMostJsonDepth, with more
/// than kMostJsonKeys, a repeated key, or a number beyond that of a double; the message begins with `name`.
Result<nlohmann::ordered_json> ParseJsonObject(std::string_view text, const std::string& name, std::string_view kind,
                                               std::string_view form, std::size_t most_bytes = kMostJsonBytes);

/// A JSON value as a message may show it: a string in quotes, of an array or object only that it is one.
std::string ShownJson(const nlohmann::ordered_json& value);

/// A JSON value as text, in one line or with so many blanks for each level. Bytes that are no UTF-8 become U+FFFD.
std::string JsonText(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace pendulum
