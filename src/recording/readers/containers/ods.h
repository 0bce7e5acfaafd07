// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "recording/readers/containers/workbook.h"
#include "recording/readers/containers/zip_members.h"

namespace pendulum {

/// The sheets of an OpenDocument spreadsheet (.ods), as CSV texts of at most `max_bytes` together. See ReadXlsx for the
/// libraries that were examined.
Workbook ReadOds(const ZipMembers& zip, std::size_t max_bytes);

/// The same for a spreadsheet in one XML text (.fods).
Workbook ReadFlatOds(std::string_view xml, std::size_t max_bytes);

}  // namespace pendulum
