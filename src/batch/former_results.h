// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pendulum {

/// Converts a stored result JSON of schema version 1 to the names of version 2; returns any other text unchanged.
/// src/docs/reference.md has the table of names.
std::string WithCurrentNames(std::string_view result);

}  // namespace pendulum
