// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/mat/mat_columns.h"

namespace pendulum {

/// Reads a recording from the bytes of a MAT-file of version 4 to 7.3. A column is a vector, a column of a matrix, or
/// the times or data of an object of class timeseries (R2010b and later), `ts.Time` and `ts.Data`. Columns have the
/// names of their variables or fields of structures. `t`, `time`, `tout` and a first column that increases are times in
/// seconds. This unit is certain only for Simulink (`tout`, a structure with `signals`) and a timeseries. Other times
/// cause a warning, or an error if they are whole numbers. Messages begin "name:". kDataLoss: the file is damaged, has
/// no such columns, has data in another file, or is larger than options.most_unpacked_bytes. If it contains another
/// object, a cell array, or complex or sparse numbers instead, the message says what to do. kInvalidArgument: a time
/// without a unit, or flags that contradict the file. kTryAgain: there is no room for a copy, or no process can be
/// started.
Result<Recording> ReadMat(std::string_view bytes, const std::string& name, const ReadOptions& options);

/// The same as ReadMat, from the table that a separate process has read from these bytes.
Result<Recording> FromMatTable(const MatTable& table, std::string_view bytes, const std::string& name,
                               const ReadOptions& options);

}  // namespace pendulum
