// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/containers/workbook.h"

namespace pendulum {

/// The words for a file with several tables.
struct WorkbookWords {
  std::string_view kind, sheet;
};

inline constexpr WorkbookWords kSheets = {"workbook", "sheet"};
inline constexpr WorkbookWords kArrays = {"file of arrays", "array"};
inline constexpr WorkbookWords kJsonTables = {"JSON text", "table"};

/// Reads a recording from a workbook, which `read` reads in a child process with limits. `bytes` are the file's.
/// Messages begin "name:sheet:row:". kDataLoss: damaged, too large, no sheet with a recording or several. kTryAgain: no
/// process could be started.
Result<Recording> ReadWorkbook(const std::function<Workbook()>& read, WorkbookWords words, std::string_view bytes,
                               const std::string& name, const ReadOptions& options);

/// Reads a recording from one of the tables. The sheets of metadata that phyphox writes are left out.
Result<Recording> FromWorkbook(Workbook workbook, WorkbookWords words, std::string_view bytes, const std::string& name,
                               const ReadOptions& options);

/// Reads a recording from an XML text: a workbook or a state of phyphox. kDataLoss: another kind of XML, which the
/// message names.
Result<Recording> ReadXml(std::string_view bytes, const std::string& name, const ReadOptions& options);

/// Reads a recording from a compound file: a workbook of Excel 5 to 2003. kDataLoss: another kind, which the message
/// names.
Result<Recording> ReadCompound(std::string_view bytes, const std::string& name, const ReadOptions& options);

/// Reads a recording from a JSON text. Messages about its form begin "name:line:column:".
Result<Recording> ReadJson(std::string_view bytes, const std::string& name, const ReadOptions& options);

}  // namespace pendulum
