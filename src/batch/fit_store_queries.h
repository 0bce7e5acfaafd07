// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "batch/sqlite.h"
#include "pendulum/batch/fit_store.h"

/// Queries of a FitStore on its tables (store_schema.h). Exceptions of SQLite are handled by sqlite::Guard.
namespace pendulum::fit_store {

inline constexpr const char* kListedColumns =
    "SELECT run, runs.id, requests.name, path, requests.created, batches.id, exit_code, runs.reason, recommended "
    "FROM requests JOIN runs USING(run) LEFT JOIN batches USING(batch) ";

inline constexpr const char* kModels = R"sql(
SELECT fits.model, status, reason, residual_unit, rms_residual, name, unit, estimate, std_error,
       systematic_std_error
  FROM fits LEFT JOIN quantities ON quantities.run = fits.run AND quantities.model = fits.model AND derived = 0
  WHERE fits.run = ? ORDER BY fits.model, name)sql";

inline constexpr const char* kBatches = R"sql(
SELECT batches.batch, batches.id, batches.created, count(run), count(exit_code), count(reason)
  FROM batches LEFT JOIN requests USING(batch) LEFT JOIN runs USING(run) )sql";

/// The texts that a filter sets, each with its parameter name in ConditionsOf.
inline std::vector<std::pair<std::string, std::string>> TextConditions(const FitFilter& filter) {
  std::vector<std::pair<std::string, std::string>> texts = {{":batch", filter.batch},
                                                            {":name", filter.name},
                                                            {":since", filter.since},
                                                            {":model", filter.model},
                                                            {":status", filter.status}};
  std::erase_if(texts, [](const auto& text) { return text.second.empty(); });
  return texts;
}

/// The SQL conditions that a filter sets. Conditions that are not set are left out, so that SQLite can use indices.
/// Names are searched with instr, which has no wildcards.
inline std::string ConditionsOf(const FitFilter& filter) {
  std::string conditions = "WHERE true";
  if (filter.before) conditions += " AND run < :before";
  if (!filter.batch.empty()) {
    conditions += " AND requests.batch = (SELECT batch FROM batches WHERE id = :batch)";
  }
  if (!filter.name.empty()) conditions += " AND instr(lower(requests.name || char(10) || path), lower(:name)) > 0";
  if (!filter.since.empty()) conditions += " AND datetime(requests.created) >= datetime(:since)";
  if (filter.model.empty() && filter.status.empty()) return conditions;
  conditions += " AND EXISTS (SELECT 1 FROM fits WHERE fits.run = requests.run";
  if (!filter.model.empty()) conditions += " AND fits.model = :model";
  if (!filter.status.empty()) conditions += " AND fits.status = :status";
  return conditions + ")";
}

inline std::optional<double> Number(const SQLite::Statement& row, int column) {
  return row.getColumn(column).isNull() ? std::nullopt : std::optional(row.getColumn(column).getDouble());
}

inline std::optional<std::string> TextOrNone(const SQLite::Statement& row, int column) {
  return row.getColumn(column).isNull() ? std::nullopt : std::optional(sqlite::Text(row, column));
}

/// The run of a row of kListedColumns.
inline ListedFit FitOf(const SQLite::Statement& row) {
  ListedFit fit;
  fit.run = row.getColumn(0).getInt64();
  fit.id = sqlite::Text(row, 1);
  fit.name = sqlite::Text(row, 2);
  fit.file = sqlite::Text(row, 3);
  fit.created = sqlite::Text(row, 4);
  fit.batch = TextOrNone(row, 5);
  if (!row.getColumn(6).isNull()) fit.exit_code = row.getColumn(6).getInt();
  fit.reason = sqlite::Text(row, 7);
  fit.recommended = TextOrNone(row, 8);
  return fit;
}

/// The window in the result of a run, if it has one.
inline std::optional<std::array<double, 2>> WindowOf(SQLite::Database& database, std::int64_t run) {
  SQLite::Statement ends(database,
                         "SELECT json_extract(result, '$.recordings[0].window_s[0]'), json_extract(result, "
                         "'$.recordings[0].window_s[1]') FROM runs WHERE run = ? AND json_valid(result)");
  if (!sqlite::Bind(ends, run).executeStep()) return std::nullopt;
  const auto begin = Number(ends, 0), end = Number(ends, 1);
  return begin && end ? std::optional(std::array{*begin, *end}) : std::nullopt;
}

/// The batch of a row of kBatches.
inline ListedBatch BatchOf(const SQLite::Statement& row) {
  const auto number = [&](int column) { return row.getColumn(column).getInt64(); };
  return {number(0), sqlite::Text(row, 1), sqlite::Text(row, 2), number(3), number(4), number(5)};
}

/// Statistical and systematic standard error, in squares; std::nullopt without a statistical one.
inline std::optional<double> TotalOf(std::optional<double> statistical, std::optional<double> systematic) {
  return statistical ? std::optional(std::hypot(*statistical, systematic.value_or(0))) : std::nullopt;
}

inline std::vector<ListedModel> ModelsOf(SQLite::Database& database, std::int64_t run) {
  SQLite::Statement rows(database, kModels);
  sqlite::Bind(rows, run);
  std::vector<ListedModel> models;
  while (rows.executeStep()) {
    const std::string name = sqlite::Text(rows, 0);
    if (models.empty() || models.back().model != name) {
      models.push_back(
          {name, sqlite::Text(rows, 1), sqlite::Text(rows, 2), sqlite::Text(rows, 3), Number(rows, 4), {}});
    }
    if (rows.getColumn(5).isNull()) continue;
    models.back().parameters.push_back({sqlite::Text(rows, 5), sqlite::Text(rows, 6), Number(rows, 7), Number(rows, 8),
                                        TotalOf(Number(rows, 8), Number(rows, 9))});
  }
  return models;
}

/// Stores a file unless an equal one is stored already. Returns its number.
inline std::int64_t StoreFile(SQLite::Database& database, const std::string& bytes, const std::string& sha256) {
  SQLite::Statement find(database, "SELECT file FROM files WHERE sha256 = ?");
  if (sqlite::Bind(find, sha256).executeStep()) return find.getColumn(0).getInt64();
  SQLite::Statement add(database, "INSERT INTO files(sha256, bytes) VALUES(?, ?)");
  add.bind(1, sha256);
  add.bind(2, bytes.data(), static_cast<int>(bytes.size()));
  add.exec();
  return database.getLastInsertRowid();
}

inline std::string FileBytes(SQLite::Database& database, std::int64_t file) {
  SQLite::Statement find(database, "SELECT bytes FROM files WHERE file = ?");
  if (!sqlite::Bind(find, file).executeStep()) return "";
  const SQLite::Column bytes = find.getColumn(0);
  return {static_cast<const char*>(bytes.getBlob()), static_cast<std::size_t>(bytes.getBytes())};
}

/// Deletes the runs that satisfy a condition on table requests, their rows, and files that no other run uses.
inline void DeleteRuns(SQLite::Database& database, const std::string& condition) {
  database.exec("CREATE TEMP TABLE leaving AS SELECT run, data, rig, calibration FROM requests WHERE " + condition);
  for (const char* table : {"quantities", "fits", "requests", "runs"}) {
    database.exec(std::string("DELETE FROM ") + table + " WHERE run IN (SELECT run FROM leaving)");
  }
  database.exec(R"sql(
DELETE FROM files WHERE file IN (SELECT data FROM leaving UNION SELECT rig FROM leaving UNION SELECT calibration FROM leaving)
  AND NOT EXISTS (SELECT 1 FROM requests WHERE data = file)
  AND NOT EXISTS (SELECT 1 FROM requests WHERE rig = file)
  AND NOT EXISTS (SELECT 1 FROM requests WHERE calibration = file))sql");
  database.exec("DROP TABLE leaving");
}

}  // namespace pendulum::fit_store
