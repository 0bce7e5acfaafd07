// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/readers/columns/read_options.h"
#include "pendulum/recording/recording.h"
#include "recording/readers/mat/mat_columns.h"

namespace pendulum {

/// Reads a recording from the bytes of a MAT-file of version 4 to 7.3. Columns are vectors and the columns of matrices
/// under the names of their variables, fields of structures, and times and data of objects of class timeseries (R2010b
/// and later), `ts.Time` and `ts.Data`; `t`, `time`, `tout` and a first column that increases are times in seconds,
/// which only Simulink's (`tout`, a structure with `signals`) and a timeseries tell: others are warned of, and refused
/// where they are whole numbers. Messages begin "name:". kDataLoss: damaged, without such columns, with data in another
/// file, or larger than options.most_unpacked_bytes; another object, a cell array, complex or sparse, with advice.
/// kInvalidArgument: a time without a unit, or what the flags say contradicts the file. kTryAgain: no room for a copy,
/// or no process.
Result<Recording> ReadMat(std::string_view bytes, const std::string& name, const ReadOptions& options);

/// The same from what a process of its own has found in these bytes.
Result<Recording> FromMatTable(const MatTable& table, std::string_view bytes, const std::string& name,
                               const ReadOptions& options);

}  // namespace pendulum
