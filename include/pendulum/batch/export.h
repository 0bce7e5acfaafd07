// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"
#include "pendulum/batch/store.h"

namespace pendulum {

/// Receives one piece of a text; an error ends the writing.
using TextSink = std::function<Result<void>(std::string_view)>;

/// Writes the refitted runs in the manifest's order, one JSON object per line: {"id", "manifest": {the manifest's data
/// of the run}, "stale": why statistics leave the run out, if they do, "former_fits": the fits of models that the last
/// refit did not ask for, if there are any, each with its part for the recording in `recordings`, "result": the result
/// JSON, or null and "error": {"exit_code", "message"}}. Only one run is in memory.
Result<void> ExportJsonLines(Store& store, const TextSink& take);

/// Writes the fits of the refitted runs as CSV (RFC 4180), one row each: id, path, rig, calibration, the manifest's
/// other columns (prefixed manifest_ if another column already has the name), model, recommended, stale (why statistics
/// leave the fit out), status, statistics, and for each quantity of any fit its estimate, std_error, lower95, upper95,
/// systematic_std_error and unit. Missing values are empty. Only one run is in memory.
Result<void> ExportCsv(Store& store, const TextSink& take);

/// A field of CSV text (RFC 4180, section 2, rules 5 to 7), quoted if necessary.
std::string CsvField(std::string_view text);

}  // namespace pendulum
