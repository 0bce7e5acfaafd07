// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "table.h"

namespace pendulum {

/// A column of numbers in a MAT-file, and what it is called there.
struct MatColumn {
  csv::TableColumn name;
  std::vector<double> values;
  bool is_unit_told = true;  // That of a time.
};

/// A variable that holds no columns, and what it is.
struct SkippedVariable {
  std::string name, kind;
};

/// What a MAT-file holds that may be a recording.
struct MatTable {
  std::vector<MatColumn> columns;
  std::vector<SkippedVariable> skipped;
  std::string complaint;  // Of matio; what it complains of cannot be trusted.
};

/// The complaint about a file whose data stand in another one.
inline constexpr std::string_view kOtherFile = "another file";

/// Reads the file at this path by matio, which was written for files of friends: it and the HDF5 library below it crash
/// on some that are damaged, so this is called in a process of its own. Both are for one thread. A file of version 7.3
/// may say that its data stand in any other file, which HDF5 would open and read, or wait for where it is a pipe: so
/// once this one is open, the process opens no more, ever.
MatTable ReadMatTable(const std::string& path);

/// The table as bytes, for the way between processes, and back.
std::string Pack(const MatTable& table);
MatTable UnpackMatTable(std::string_view bytes);

}  // namespace pendulum
