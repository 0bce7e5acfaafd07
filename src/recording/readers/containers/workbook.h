// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "recording/readers/containers/csv_text.h"

namespace pendulum {

/// A sheet of a workbook, or another table of a file with several.
struct Sheet {
  std::string name;
  std::string text;  // CSV text; empty for an empty sheet.
};

/// The tables of a file: sheets of a workbook, sets of columns of phyphox, arrays.
struct Workbook {
  std::vector<Sheet> sheets;
  std::string complaint;  // Why the file could not be read, and what to do; otherwise empty.
  std::string place;      // Where, if known: "LINE:COLUMN".
  bool is_too_large = false;
};

/// The rows of a sheet in Excel and LibreOffice. A file may claim to have more, to use up memory.
inline constexpr std::size_t kMaxSheetRows = std::size_t{1} << 20;

/// Sets the text of a sheet and subtracts its size from max_bytes, the limit of the sheets that follow. Returns false
/// and sets the complaint, or is_too_large, if cells were left out.
bool FinishSheet(CsvText& csv, std::size_t& max_bytes, Sheet& sheet, Workbook& workbook);

/// Sets the complaint of a workbook of Excel without a sheet of cells.
void ComplainIfEmpty(Workbook& workbook);

/// A workbook as bytes, to be sent by a child process.
std::string Pack(const Workbook& workbook);

Workbook UnpackWorkbook(std::string_view bytes);

}  // namespace pendulum
