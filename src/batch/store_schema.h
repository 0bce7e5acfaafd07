// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace pendulum {

/// PRAGMA application_id of a result store: "Pend" in ASCII.
inline constexpr int kStoreId = 0x50656e64;

/// Migrations of a store's tables: element n - 1 updates version n - 1 to n (PRAGMA user_version), n from 1 on. A
/// released migration is never changed; a new one is appended, and tests/batch/golden_stores.py adds a store with it.
/// The view `results` is replaced after them (ResultsView). SQLite keeps the comments, so .schema explains the tables.
inline constexpr std::array<std::string_view, 9> kStoreMigrations = {R"sql(
CREATE TABLE meta(  -- about the whole store, of the last refit: version, manifest_sha256, options_sha256,
                    -- shard and shard_count (of a shard only), runs, complete (1 when every run has its rows)
  key TEXT PRIMARY KEY, value) WITHOUT ROWID;

CREATE TABLE options(  -- what was asked of all fits of a batch: meta's options_sha256, and those of earlier ones
  sha256 TEXT PRIMARY KEY, json TEXT NOT NULL) WITHOUT ROWID;

CREATE TABLE runs(  -- one row a run: what the manifest says of it, and what came of it
  run INTEGER PRIMARY KEY,        -- of this store only; id is the run's name elsewhere
  id TEXT NOT NULL UNIQUE,
  position INTEGER NOT NULL,      -- in the manifest, from 0; -1: the last manifest did not name it
  path TEXT NOT NULL,             -- as in the manifest, as rig and calibration; '' for none
  rig TEXT NOT NULL,
  calibration TEXT NOT NULL,
  from_s REAL,                    -- window, s on the file's clock; NULL as of the whole batch
  to_s REAL,
  models TEXT NOT NULL,           -- '' for those of the whole batch
  columns TEXT NOT NULL,          -- the manifest's other columns, a JSON object of texts
  exit_code INTEGER,              -- that of fit_pendulum for this recording; NULL: not refitted yet
  reason TEXT,                    -- why it could not be fitted; NULL where it could
  recommended TEXT,               -- of several models, if one is
  data_sha256 TEXT,               -- of the recording's bytes, as rig and calibration; '' for none, or 'unreadable: why'
  rig_sha256 TEXT,
  calibration_sha256 TEXT,
  options_sha256 TEXT,            -- of what was asked of it: the batch's options with its own window, models and paths
  version TEXT,                   -- of the program
  cpu TEXT,                       -- the type of CPU, on which the last bits of the values depend
  result TEXT);                   -- result JSON (result.schema.json); NULL where it could not be fitted

CREATE TABLE fits(  -- one row for each run and model
  run INTEGER NOT NULL REFERENCES runs, model TEXT NOT NULL,
  status TEXT NOT NULL,           -- converged, not_converged, not_identifiable or failed
  reason TEXT NOT NULL,
  used_samples INTEGER, effective_samples REAL,
  residual_unit TEXT,             -- of rms_residual and sigma, as in the result JSON: rad, rad_s, counts or volts
  rms_residual REAL, sigma REAL, noise_model TEXT, lag1_correlation REAL,
  log_likelihood REAL, aic REAL, aicc REAL, bic REAL, durbin_watson REAL, ljung_box_p REAL, runs_p REAL,
  iterations INTEGER, evaluations INTEGER,
  PRIMARY KEY(run, model)) WITHOUT ROWID;

CREATE TABLE quantities(  -- one row for each parameter of a fit, and each quantity derived from them
  run INTEGER NOT NULL, model TEXT NOT NULL, name TEXT NOT NULL,
  derived INTEGER NOT NULL,       -- 0: a parameter
  estimate REAL, std_error REAL, lower95 REAL, upper95 REAL, systematic_std_error REAL,
  unit TEXT NOT NULL, fixed INTEGER NOT NULL, at_bound INTEGER NOT NULL,
  PRIMARY KEY(run, model, name), FOREIGN KEY(run, model) REFERENCES fits) WITHOUT ROWID;

CREATE VIEW results AS  -- the fits with the id of their run
  SELECT id, position, path, runs.recommended = model AS recommended, fits.* FROM runs JOIN fits USING(run);
)sql",
                                                                     R"sql(
CREATE TABLE files(  -- what a service was sent, each once: recordings, rigs, calibrations
  file INTEGER PRIMARY KEY, sha256 TEXT NOT NULL UNIQUE, bytes BLOB NOT NULL);

CREATE TABLE batches(  -- one row for each batch that a service accepted
  batch INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE,
  created TEXT NOT NULL);         -- RFC 3339, UTC

CREATE TABLE requests(  -- one row for each run that a service was asked for; its name is the run's path
  run INTEGER PRIMARY KEY REFERENCES runs,
  batch INTEGER REFERENCES batches,  -- NULL: asked for alone
  created TEXT NOT NULL,
  flags TEXT NOT NULL,            -- what was asked, a JSON object of texts by the flags' names
  data INTEGER NOT NULL REFERENCES files, rig INTEGER REFERENCES files, calibration INTEGER REFERENCES files);
CREATE INDEX requests_of_batch ON requests(batch, run);
CREATE INDEX requests_of_data ON requests(data);
CREATE INDEX requests_of_rig ON requests(rig);
CREATE INDEX requests_of_calibration ON requests(calibration);

CREATE TABLE answers(  -- where the answer is to what a client may ask again: its idempotency key, and what it sent
  key TEXT PRIMARY KEY, request_sha256 TEXT NOT NULL, location TEXT NOT NULL, created TEXT NOT NULL) WITHOUT ROWID;
CREATE INDEX answers_by_age ON answers(created);
CREATE INDEX answers_by_place ON answers(location);
)sql",
                                                                     R"sql(
UPDATE quantities SET name = 'hysteresis' WHERE name = 'edge_lag';  -- renamed in schema version 2 of the result JSON
)sql",
                                                                     R"sql(
ALTER TABLE fits ADD COLUMN verdict TEXT;  -- whether the law describes the readings, in a sentence; NULL: not known
ALTER TABLE quantities ADD COLUMN total_std_error REAL;  -- of std_error and systematic_std_error together
DROP VIEW results;
CREATE VIEW all_fits AS  -- the fits with the id of their run
  SELECT id, position, path, runs.recommended = model AS recommended, fits.* FROM runs JOIN fits USING(run);
ALTER TABLE requests ADD COLUMN name TEXT NOT NULL DEFAULT '';  -- given by the client; '' for none
ALTER TABLE runs ADD COLUMN sources TEXT;  -- clock and calibration: runs with the same text share the errors of both
ALTER TABLE quantities ADD COLUMN inconstancy_std_error REAL;  -- the part of systematic_std_error from parameters that
                                                               -- are not constant; it differs between runs
ALTER TABLE quantities ADD COLUMN source_std_error REAL;       -- the part from clock and calibration
)sql",
                                                                     R"sql(
ALTER TABLE runs ADD COLUMN stale TEXT;    -- why the last attempt left the former result in place; NULL: it is current
ALTER TABLE runs ADD COLUMN attempt TEXT;  -- hash of what that attempt was made with; NULL: the result is current
)sql",
                                                                     R"sql(
ALTER TABLE fits ADD COLUMN stale TEXT;  -- why the result of the run does not have this fit; NULL: it has
ALTER TABLE fits ADD COLUMN json TEXT;   -- the fit as the former result had it; NULL where stale is
CREATE INDEX unlisted_by_data ON runs(data_sha256) WHERE position < 0;
)sql",
                                                                     R"sql(
UPDATE fits SET residual_unit = 'm_s2' WHERE residual_unit = 'm_s^2';  -- and the results are converted to schema version 3
)sql",
                                                                     R"sql(
ALTER TABLE runs ADD COLUMN place TEXT;     -- what reason or stale is about: a path, perhaps with a line; NULL: not known
ALTER TABLE runs ADD COLUMN sentence TEXT;  -- reason or stale without its place
UPDATE runs SET place = path, sentence = substr(coalesce(stale, reason), length(path) + 3)
  WHERE substr(coalesce(stale, reason), 1, length(path) + 2) = path || ': ';
UPDATE runs SET sentence = ltrim(substr(reason, length(path) + 1), ':0123456789 ')  -- behind line and column
  WHERE sentence IS NULL AND substr(reason, 1, length(path)) = path AND substr(reason, length(path) + 1) GLOB ':[0-9]*';
UPDATE runs SET place = rtrim(substr(reason, 1, length(reason) - length(sentence)), ': ')
  WHERE sentence IS NOT NULL AND place IS NULL;
)sql",
                                                                     R"sql(
ALTER TABLE runs ADD COLUMN fitted TEXT;  -- when its rows were stored, RFC 3339, UTC; NULL: not known
ALTER TABLE runs ADD COLUMN news TEXT;    -- what the last refit did: new (its first fit) or again; NULL: nothing
)sql"};

/// The first version whose quantities have total_std_error, and runs have sources.
inline constexpr int kFirstWithTotalErrors = 4;

/// The last version that stored results in an earlier schema of the result JSON.
inline constexpr int kLastFormerResults = 6;

}  // namespace pendulum
