// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/base/warning.h"

namespace pendulum {

/// A question of a reader: what neither the file nor the user's options say.
struct ReadQuestion {
  std::string sentence;                ///< With the flags that answer it.
  std::vector<std::string> options;    ///< The flags that answer it, without dashes: "unit".
  std::vector<std::string> try_flags;  ///< Examples, as Status::try_flags; may be empty.
  std::vector<std::string> values;     ///< Possible values of the first option, if the table's columns are not these.
};

/// The table of a file as a person sees it, and what a reader chose in it. A reader fills it as far as it gets, also if
/// it fails.
struct TablePreview {
  static constexpr std::size_t kRows = 8;

  /// A chosen column.
  struct Column {
    std::size_t index = 0;  ///< From 0, in `names`.
    std::string unit;       ///< As the flags take it: ms, deg, rad_s ...; empty: unknown.
  };

  std::string format;              ///< "workbook", "text with columns separated by commas"
  std::string member;              ///< The sheet, file or array that was read, if the file has several; else empty.
  std::vector<std::string> names;  ///< Of the columns, as the flags take them: the name, or the number from 1.
  std::vector<std::vector<std::string>> rows;  ///< The first rows, at most kRows, cells as they are written.
  std::optional<Column> time, value;
  std::vector<Warning> assumptions;     ///< What was assumed in choosing the columns.
  std::vector<ReadQuestion> questions;  ///< What the user must tell; empty if the columns are chosen.
};

}  // namespace pendulum
