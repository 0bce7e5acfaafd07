// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "batch/run_groups.h"
#include "batch/sqlite.h"

namespace pendulum {

/// How the runs of a store ended, in numbers and examples.
struct RunCounts {
  std::int64_t runs = 0;
  std::int64_t fitted = 0;            ///< The fit of the recommended law converged.
  std::int64_t not_converged = 0;     ///< It did not.
  std::int64_t missing = 0;           ///< There is no such recording.
  std::int64_t refused = 0;           ///< Could not be read or fitted.
  std::int64_t without_rig_file = 0;  ///< Of these, runs whose rig or calibration is missing.
  std::int64_t pending = 0;           ///< Not fitted yet.
  std::int64_t stale = 0;             ///< Only a former result is there; the last attempt failed.
  std::int64_t unlisted = 0;          ///< Not among the recordings of the last refit, nor among `runs`.
  bool is_complete = true;            ///< No refit was stopped before its end, and none is running.
  struct Run {
    std::string id, reason;
  };
  std::vector<Run> missing_runs, refused_runs, stale_runs;  ///< At most ten each, in the order of the manifest.
};

RunCounts CountRuns(SQLite::Database& database);

/// "197 of 200 recordings fitted; 1 missing, 1 refused, 1 with a former result only".
std::string CountsText(const RunCounts& counts);

nlohmann::ordered_json CountsJson(const RunCounts& counts);

/// The law of the conclusions: of the fitted recordings that have repeats (of all, if none has), the law that was most
/// often recommended or the only one. Otherwise the first model with a converged fit.
std::string MainModel(SQLite::Database& database, const nlohmann::ordered_json& overview, const RunGroups& groups);

/// Whether the errors of a model agree with the scatter between recordings. `parameters`: as in the summary.
/// `left_out`: whether recordings that disagree are left out.
nlohmann::ordered_json VerdictJson(const std::string& model, const nlohmann::ordered_json& parameters,
                                   const RunGroups& groups, bool left_out);

}  // namespace pendulum
