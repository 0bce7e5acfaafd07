// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "batch/run_kinds.h"

/// Queries of a Store on its tables (store_schema.h).
namespace pendulum {

inline constexpr const char* kBatchTable = R"sql(
CREATE TEMP TABLE batch(position INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, path TEXT, rig TEXT, calibration TEXT,
  from_s REAL, to_s REAL, models TEXT, columns TEXT, place TEXT);
CREATE INDEX temp.batch_by_rig ON batch(rig);
CREATE INDEX temp.batch_by_calibration ON batch(calibration))sql";

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

/// Unlisted runs that may be a run of the batch without a result under its former name: the same data, window, files
/// and models.
inline const std::string kRenamedRuns =
    "SELECT runs.run, runs.path, runs.path IS batch.path FROM runs JOIN batch ON batch.id = ? AND runs.from_s IS "
    "batch.from_s AND runs.to_s IS batch.to_s AND runs.rig IS batch.rig AND runs.calibration IS batch.calibration AND "
    "runs.models IS batch.models WHERE runs.data_sha256 = ? AND runs.result IS NOT NULL AND "
    "NOT EXISTS (SELECT * FROM runs AS own WHERE own.id = batch.id AND own.result IS NOT NULL) AND " +
    kIsUnlisted + " ORDER BY runs.run";

inline constexpr const char* kRenameRun = R"sql(
UPDATE runs SET (id, position, path, rig, calibration, from_s, to_s, models, columns) =
    (SELECT id, position, path, rig, calibration, from_s, to_s, models, columns FROM batch WHERE id = ?)
  WHERE run = ?)sql";

/// Marks the fits of a run whose models, a JSON array, are not among those of its next result.
inline constexpr const char* kKeepFits = R"sql(
UPDATE fits SET stale = 'the last refit did not ask for this model',
    json = (SELECT json_set(fit.value, '$.recordings', json((SELECT json_group_array(json(part.value))
                FROM json_each(result, '$.recordings') AS recording, json_each(recording.value, '$.fits') AS part
                WHERE json_extract(part.value, '$.model') = fits.model)))
              FROM runs, json_each(iif(json_valid(result), result, '{}'), '$.fits') AS fit
              WHERE runs.run = fits.run AND json_extract(fit.value, '$.model') = fits.model)
  WHERE run = ?1 AND stale IS NULL AND status <> 'failed' AND model NOT IN (SELECT value FROM json_each(?2)))sql";

/// Deletes the fits of a run that are neither marked nor of other models than these, a JSON array.
inline constexpr const char* kDropQuantities = R"sql(
DELETE FROM quantities WHERE run = ?1 AND model IN
  (SELECT model FROM fits WHERE run = ?1 AND (stale IS NULL OR model IN (SELECT value FROM json_each(?2)))))sql";
inline constexpr const char* kDropFits = R"sql(
DELETE FROM fits WHERE run = ?1 AND (stale IS NULL OR model IN (SELECT value FROM json_each(?2))))sql";

/// Marks the results of manifests' runs for which a condition is true, because what is asked of them has changed.
inline std::string MarkFormer(const std::string& condition) {
  return "UPDATE runs SET stale = 'the options, rig or calibration changed, and this run has not been fitted again "
         "yet' WHERE result IS NOT NULL AND stale IS NULL AND run NOT IN (SELECT run FROM requests) AND " +
         condition;
}

/// What the manifest says of a run differs from what it said before.
inline constexpr const char* kHasOtherEntry = R"sql(
EXISTS (SELECT * FROM batch WHERE batch.id = runs.id AND (batch.path, batch.rig, batch.calibration, batch.from_s,
    batch.to_s, batch.models) IS NOT (runs.path, runs.rig, runs.calibration, runs.from_s, runs.to_s, runs.models)))sql";

/// Makes the results of the batch former ones, which are not current whatever their inputs are.
inline constexpr const char* kForgetProvenance = R"sql(
UPDATE runs SET stale = '--force asked for a new fit, and this run has not been fitted again yet',
    place = NULL, sentence = NULL, options_sha256 = '', attempt = NULL
  WHERE result IS NOT NULL AND id IN (SELECT id FROM batch))sql";

inline constexpr const char* kPutRun = R"sql(
UPDATE runs SET exit_code = ?, reason = ?, place = ?, sentence = ?, recommended = ?, data_sha256 = ?, rig_sha256 = ?, calibration_sha256 = ?,
  options_sha256 = ?, version = ?, cpu = ?, result = ?, sources = ?, stale = NULL, attempt = NULL,
  fitted = ?, news = iif(exit_code IS NULL, 'new', 'again')
  WHERE run = ?)sql";

}  // namespace pendulum
