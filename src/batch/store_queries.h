// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Queries of a Store on its tables (store_schema.h).
namespace pendulum {

inline constexpr const char* kBatchTable = R"sql(
CREATE TEMP TABLE batch(position INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, path TEXT, rig TEXT, calibration TEXT,
  from_s REAL, to_s REAL, models TEXT, columns TEXT, place TEXT))sql";

inline constexpr const char* kUpdateRuns = R"sql(
INSERT INTO runs(id, position, path, rig, calibration, from_s, to_s, models, columns)
  SELECT id, position, path, rig, calibration, from_s, to_s, models, columns FROM batch WHERE true ORDER BY position
  ON CONFLICT(id) DO UPDATE SET position = excluded.position, path = excluded.path, rig = excluded.rig,
    calibration = excluded.calibration, from_s = excluded.from_s, to_s = excluded.to_s, models = excluded.models,
    columns = excluded.columns)sql";

inline constexpr const char* kNextRuns = R"sql(
SELECT batch.position, id, batch.path, batch.rig, batch.calibration, batch.from_s, batch.to_s, batch.models,
    batch.columns, exit_code, data_sha256, rig_sha256, calibration_sha256, options_sha256, version, stale,
    attempt
  FROM batch JOIN runs USING(id) WHERE batch.position >= ? ORDER BY batch.position LIMIT ?)sql";

// Runs are numbered in the order of their arrival.
inline constexpr const char* kAddRun = R"sql(
INSERT INTO runs(id, position, path, rig, calibration, from_s, to_s, models, columns)
  VALUES(?, (SELECT coalesce(max(run), -1) + 1 FROM runs), ?, ?, ?, ?, ?, ?, ?))sql";

inline constexpr const char* kPutRun = R"sql(
UPDATE runs SET exit_code = ?, reason = ?, recommended = ?, data_sha256 = ?, rig_sha256 = ?, calibration_sha256 = ?,
  options_sha256 = ?, version = ?, cpu = ?, result = ?, sources = ?, stale = NULL, attempt = NULL
  WHERE run = ?)sql";

}  // namespace pendulum
