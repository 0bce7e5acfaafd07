// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "recording/readers/containers/workbook.h"
#include "recording/readers/containers/zip_members.h"

namespace pendulum {

/// True for a zip file that is a workbook of Excel 2007 or later (.xlsx, .xlsm).
bool IsXlsx(const ZipMembers& zip);

/// The sheets of a workbook of Excel 2007 or later, as CSV texts of at most `max_bytes` together.
///
/// Read with libzip and expat. Libraries of Debian that were examined: liborcus 0.17 finds no cell in workbooks of
/// openpyxl and pandas, loses text that is stored in the cell, and rounds 2 % of the numbers wrongly. FreeXL 1.0 reads
/// .xls only. A converter (ssconvert of Gnumeric, LibreOffice) takes hundreds of megabytes to install.
Workbook ReadXlsx(const ZipMembers& zip, std::size_t max_bytes);

}  // namespace pendulum
