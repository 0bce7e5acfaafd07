// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "recording/readers/containers/workbook.h"

namespace pendulum {

/// The sheets of a workbook of Excel 5 to 2003 (.xls), as CSV texts of at most `max_bytes` together.
///
/// Implements the few records of [MS-XLS] with values of cells. Libraries of Debian that were examined: FreeXL 1.0
/// ignores cells with formulas, reads the errors of cells as 1 and cuts times to seconds. liborcus reads no .xls. See
/// ReadXlsx for converters.
Workbook ReadXls(std::string_view bytes, std::size_t max_bytes);

}  // namespace pendulum
