// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "recording/readers/containers/workbook.h"

namespace pendulum {

/// The recording in a saved state of phyphox (.phyphox), an XML text with the experiment and the contents of its
/// buffers. Each set of the element <export>, which names columns with units, becomes a table of at most `max_bytes`
/// together. Without <export>, all buffers are the columns of one table.
Workbook ReadPhyphoxState(std::string_view xml, std::size_t max_bytes);

}  // namespace pendulum
