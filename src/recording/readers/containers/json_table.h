// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "recording/readers/containers/workbook.h"

namespace pendulum {

/// The tables in a JSON text, as CSV texts of at most `max_bytes` together:
/// - an object of arrays: {"t": [0, 1], "angle_deg": [3, 4]}, also as phyphox sends it ("buffer");
/// - an array of objects: [{"t": 0, "angle_deg": 3}, ...], or one object on each line;
/// - an array of rows: [[0, 3], [1, 4]], the first of which may contain names; or one row on each line;
/// - the forms of pandas: {"t": {"0": 0, "1": 1}, ...} and {"columns": [...], "data": [...]};
/// - objects with such tables, each of which is named after its key.
/// Other members with the keys of metadata, such as sample_rate_hz, become lines `# key: value`.
Workbook ReadJsonTables(std::string_view text, std::size_t max_bytes);

}  // namespace pendulum
