// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "recording/readers/containers/workbook.h"

namespace pendulum {

/// The sheets of a workbook in the XML of Excel 2003, which instruments and web pages save as .xls or .xml. The CSV
/// texts have at most `max_bytes` together.
Workbook ReadExcelXml(std::string_view xml, std::size_t max_bytes);

}  // namespace pendulum
