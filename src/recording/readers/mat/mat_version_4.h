// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace pendulum {

/// The size in bytes, with header and name, of the variable of a MAT-file of version 4 that begins at the start of
/// `bytes`, which may be shorter. std::nullopt if no variable begins there. A file of version 4 has no header of its
/// own. Five numbers before each variable's name give its type and size ("MAT-File Format", The MathWorks). They
/// contain zero bytes, which a text file does not.
std::optional<std::size_t> SizeOfVersion4(std::string_view bytes);

}  // namespace pendulum
