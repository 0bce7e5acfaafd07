// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// Takes a text piece by piece; an error ends the writing.
using TakeText = std::function<Result<void>(std::string_view)>;

/// The runs that were refitted, in the manifest's order, one JSON object a line: {"id", "manifest": {what it says of
/// the run}, "result": the result JSON, or null and "error": {"exit_code", "message"}}. Memory: one run.
Result<void> ExportJsonLines(Store& store, const TakeText& take);

/// The fits of these runs as CSV (RFC 4180), one row each: id, path, rig, calibration, the manifest's other columns
/// (prefixed manifest_ where another column has the name), model, status, statistics, and for each quantity of any fit
/// its estimate, std_error, lower95, upper95, systematic_std_error and unit. What does not exist is empty. Memory: one
/// run.
Result<void> ExportCsv(Store& store, const TakeText& take);

/// A field of CSV text (RFC 4180, section 2, rules 5 to 7), in quotes where it needs them.
std::string CsvField(std::string_view text);

}  // namespace pendulum
