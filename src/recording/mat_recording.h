// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "pendulum/recording/read_recording.h"

namespace pendulum {

/// Reads a recording from the bytes of a MAT-file of version 5 to 7.3. Columns are vectors and the columns of matrices
/// under the names of their variables, fields of structures, and timeseries; `t`, `time` and `tout` are times in
/// seconds, as is a first column that increases. Messages begin "name:". kDataLoss: damaged, or without such columns.
Result<Recording> ReadMat(std::string_view bytes, const std::string& name, const ReadOptions& options);

}  // namespace pendulum
