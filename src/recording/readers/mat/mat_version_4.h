// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace pendulum {

/// The bytes of the variable of a MAT-file of version 4 that begins here, header and name included, which these bytes
/// may be too few for; none where no variable begins. Such a file has no header of its own: five numbers before each
/// variable's name tell its type and size ("MAT-File Format", The MathWorks), and a text has no zeros there.
std::optional<std::size_t> SizeOfVersion4(std::string_view bytes);

}  // namespace pendulum
