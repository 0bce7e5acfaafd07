// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace pendulum {

/// The size in bytes of the variable of a MAT-file of version 4 that begins here, with header and name. `bytes` may be
/// shorter. std::nullopt if no variable begins here. Such a file has no header of its own. Five numbers before each
/// variable's name give its type and size ("MAT-File Format", The MathWorks); a text has no zeros there.
std::optional<std::size_t> SizeOfVersion4(std::string_view bytes);

}  // namespace pendulum
