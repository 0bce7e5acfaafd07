// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/mat/mat_columns.h"

namespace pendulum {

/// Reads a recording from the bytes of a MAT-file of version 4 to 7.3. Columns are vectors and columns of matrices,
/// named after their variables, fields of structures, and times and data of objects of class timeseries (R2010b and
/// later), `ts.Time` and `ts.Data`. `t`, `time`, `tout` and a first column that increases are times in seconds. This
/// unit is certain only for Simulink (`tout`, a structure with `signals`) and a timeseries. Other times cause a
/// warning, or an error if they are whole numbers. Messages begin "name:". kDataLoss: damaged, without such columns,
/// with data in another file, or larger than options.most_unpacked_bytes; another object, a cell array, complex or
/// sparse numbers, with advice. kInvalidArgument: a time without a unit, or flags that contradict the file. kTryAgain:
/// no room for a copy, or no process.
Result<Recording> ReadMat(std::string_view bytes, const std::string& name, const ReadOptions& options);

/// The same from the table that a separate process has read from these bytes.
Result<Recording> FromMatTable(const MatTable& table, std::string_view bytes, const std::string& name,
                               const ReadOptions& options);

}  // namespace pendulum
