// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pendulum {

/// A stored result JSON of schema version 1 with the names of version 2; any other text unchanged.
/// src/docs/reference.md has the table of names.
std::string WithCurrentNames(std::string_view result);

}  // namespace pendulum
