// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"

namespace pendulum {

/// Far above the size of any rig or calibration file. The limit exists because ordered_json searches its keys linearly.
inline constexpr std::size_t kMaxJsonBytes = 65536;

/// Limits of nesting and of the number of keys, both above what any rig or request needs. More would cost time and
/// stack.
inline constexpr int kMaxJsonDepth = 32, kMaxJsonKeys = 4096;

/// Parses a JSON object in which no object repeats a key. Messages call it a `kind`, such as "rig", and show `form` as
/// an example. kDataLoss: not JSON (line and column), not an object, longer than `max_bytes`, deeper than
/// kMaxJsonDepth, more than kMaxJsonKeys keys, a repeated key, or a number beyond the range of a double. The message
/// begins with `name`.
Result<nlohmann::ordered_json> ParseJsonObject(std::string_view text, const std::string& name, std::string_view kind,
                                               std::string_view form, std::size_t max_bytes = kMaxJsonBytes);

/// A JSON value as messages show it: a string in quotes; for an array or object only "an array" or "an object".
std::string JsonForMessage(const nlohmann::ordered_json& value);

/// A JSON value as text: on one line, or with `indent` spaces per level. Invalid UTF-8 becomes U+FFFD.
std::string JsonText(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace pendulum
