// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pendulum {

/// Converts a stored result JSON of schema version 1 or 2 to version 3; returns any other text unchanged.
/// src/docs/reference.md has the tables of names and places.
std::string ToCurrentResult(std::string_view result);

/// The same for a single fit of a result of version 2 for one recording, as a store keeps it of a law that was not
/// asked for again: its own part becomes the only item of `recordings`.
std::string ToCurrentFit(std::string_view fit);

}  // namespace pendulum
