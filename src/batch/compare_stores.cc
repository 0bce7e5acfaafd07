// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/compare_stores.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "batch/run_kinds.h"
#include "batch/sqlite.h"

namespace pendulum {
namespace {

/// Pairs the runs of both stores that have fits to compare: those with the same id, and those of recordings that were
/// renamed in between, which have the same content, window, rig, calibration and models. Copies of one recording are
/// paired in the order of their runs.
constexpr const char* kPairRuns = R"sql(
CREATE TEMP TABLE runs_before AS SELECT * FROM main.runs WHERE run IN (SELECT run FROM fits_before);
CREATE TEMP TABLE runs_after AS SELECT * FROM other.runs WHERE run IN (SELECT run FROM fits_after);
CREATE INDEX temp.runs_after_by_id ON runs_after(id);
CREATE TEMP TABLE pairs(before INTEGER PRIMARY KEY, after INTEGER UNIQUE, is_renamed INTEGER);
INSERT INTO pairs SELECT mine.run, theirs.run, 0 FROM runs_before AS mine JOIN runs_after AS theirs USING(id);
CREATE TEMP TABLE left_before AS
  SELECT run, key, row_number() OVER (PARTITION BY key ORDER BY run) AS number FROM
    (SELECT run, json_array(data_sha256, from_s, to_s, rig_sha256, calibration_sha256, models) AS key FROM runs_before
      WHERE result IS NOT NULL AND run NOT IN (SELECT before FROM pairs));
CREATE TEMP TABLE left_after AS
  SELECT run, key, row_number() OVER (PARTITION BY key ORDER BY run) AS number FROM
    (SELECT run, json_array(data_sha256, from_s, to_s, rig_sha256, calibration_sha256, models) AS key FROM runs_after
      WHERE result IS NOT NULL AND run NOT IN (SELECT after FROM pairs));
CREATE INDEX temp.left_after_by_key ON left_after(key, number);
INSERT INTO pairs SELECT mine.run, theirs.run, 1 FROM left_before AS mine JOIN left_after AS theirs USING(key, number))sql";

constexpr const char* kDropPairs = R"sql(
DROP TABLE pairs; DROP TABLE left_before; DROP TABLE left_after; DROP TABLE runs_before; DROP TABLE runs_after;
DROP VIEW fits_before; DROP VIEW fits_after; DETACH other)sql";

constexpr const char* kFits = R"sql(
SELECT mine.id, mine.model, mine.status, theirs.status
  FROM fits_before AS mine JOIN pairs ON before = mine.run
  JOIN fits_after AS theirs ON theirs.run = after AND theirs.model = mine.model
  ORDER BY mine.position, mine.id, mine.model)sql";

constexpr const char* kRemovedFits = R"sql(
SELECT id, model FROM fits_before AS mine
  WHERE NOT EXISTS (SELECT * FROM pairs JOIN fits_after AS theirs ON theirs.run = after
    WHERE before = mine.run AND theirs.model = mine.model)
  ORDER BY position, id, model LIMIT ?)sql";

constexpr const char* kParameters = R"sql(
SELECT fits_before.id, mine.model, mine.name, mine.unit, mine.estimate, theirs.estimate, mine.std_error,
    theirs.std_error, theirs.unit
  FROM fits_before JOIN pairs ON before = fits_before.run
  JOIN fits_after ON fits_after.run = after AND fits_after.model = fits_before.model
  JOIN main.quantities AS mine ON mine.run = fits_before.run AND mine.model = fits_before.model
  JOIN other.quantities AS theirs
    ON theirs.run = fits_after.run AND theirs.model = mine.model AND theirs.name = mine.name
  WHERE mine.derived = 0)sql";

/// Creates a view of the fits in a store that are not stale. A store of a former version on a read-only disk has no
/// marks, so the view has all of its fits.
void CreateView(SQLite::Database& database, const std::string& view, const std::string& schema) {
  SQLite::Statement columns(database, "SELECT count(*) FROM pragma_table_info('fits', ?) WHERE name = 'stale'");
  sqlite::Bind(columns, schema).executeStep();
  const bool has_marks = columns.getColumn(0).getInt() > 0;
  database.exec("CREATE TEMP VIEW " + view +
                " AS SELECT runs.id, runs.position, fits.run, fits.model, fits.status FROM " + schema +
                ".runs AS runs JOIN " + schema + ".fits AS fits USING(run)" +
                (has_marks ? " WHERE " + IsLiveFit(schema + ".requests") : ""));
}

std::int64_t CountOf(SQLite::Database& database, const std::string& table) {
  return database.execAndGet("SELECT count(*) FROM " + table).getInt64();
}

std::vector<std::string> CpusOf(SQLite::Database& database, const std::string& schema) {
  return sqlite::Texts(database, "SELECT DISTINCT cpu FROM " + schema + ".runs WHERE cpu IS NOT NULL ORDER BY cpu");
}

void CompareFits(SQLite::Database& database, StoreComparison& comparison) {
  SQLite::Statement fits(database, kFits);
  while (fits.executeStep()) {
    ++comparison.fits;
    ChangedStatus status{sqlite::Text(fits, 0), sqlite::Text(fits, 1), sqlite::Text(fits, 2), sqlite::Text(fits, 3)};
    if (status.before == status.after) continue;
    if (comparison.changed_status++ < StoreComparison::kMaxListed) comparison.status_changes.push_back(status);
  }
  const std::int64_t before = CountOf(database, "fits_before"), after = CountOf(database, "fits_after");
  comparison.only_before = before - comparison.fits;
  comparison.only_after = after - comparison.fits;
  comparison.stale_before = CountOf(database, "main.fits") - before;
  comparison.stale_after = CountOf(database, "other.fits") - after;
  SQLite::Statement removed(database, kRemovedFits);
  sqlite::Bind(removed, StoreComparison::kMaxListed);
  while (removed.executeStep()) comparison.removed.push_back({sqlite::Text(removed, 0), sqlite::Text(removed, 1)});
  comparison.other_data = database
                              .execAndGet(
                                  "SELECT count(*) FROM main.runs AS a JOIN other.runs AS b USING(id) "
                                  "WHERE a.data_sha256 <> b.data_sha256")
                              .getInt64();
  comparison.renamed = CountOf(database, "pairs WHERE is_renamed");
}

/// Adds a change to the kMaxListed largest ones, a heap whose front is the smallest of them.
void AddToLargest(MovedParameter moved, std::vector<MovedParameter>& largest) {
  const auto more = [](const MovedParameter& a, const MovedParameter& b) { return a.errors > b.errors; };
  largest.push_back(std::move(moved));
  std::ranges::push_heap(largest, more);
  if (largest.size() <= static_cast<std::size_t>(StoreComparison::kMaxListed)) return;
  std::ranges::pop_heap(largest, more);
  largest.pop_back();
}

void CompareParameter(const SQLite::Statement& row, StoreComparison& comparison) {
  const SQLite::Column before = row.getColumn(4), after = row.getColumn(5);
  const SQLite::Column error_before = row.getColumn(6), error_after = row.getColumn(7);
  const auto same = [](const SQLite::Column& a, const SQLite::Column& b) {
    return a.isNull() == b.isNull() && a.getDouble() == b.getDouble();
  };
  if (same(before, after) && same(error_before, error_after)) {
    ++comparison.identical;
    return;
  }
  if (sqlite::Text(row, 3) != sqlite::Text(row, 8)) {  // only one of the two fits had a rig
    ++comparison.without_error;
    return;
  }
  const double error = std::min(error_before.getDouble(), error_after.getDouble());
  if (before.isNull() || after.isNull() || error_before.isNull() || error_after.isNull() || !(error > 0)) {
    ++comparison.without_error;
    return;
  }
  const double moved = std::max(std::abs(after.getDouble() - before.getDouble()),
                                std::abs(error_after.getDouble() - error_before.getDouble())) /
                       error;
  if (moved <= 1) {
    ++(moved <= StoreComparison::kRounding ? comparison.rounding : comparison.within_errors);
    return;
  }
  ++comparison.moved;
  AddToLargest({sqlite::Text(row, 0), sqlite::Text(row, 1), sqlite::Text(row, 2), sqlite::Text(row, 3),
                before.getDouble(), after.getDouble(), moved},
               comparison.most_moved);
}

}  // namespace

Result<StoreComparison> CompareStores(Store& before, Store& after) {
  return sqlite::Guard(before.name(), [&]() -> Result<StoreComparison> {
    SQLite::Database& database = before.database();
    SQLite::Statement attach(database, "ATTACH ? AS other");
    sqlite::Bind(attach, sqlite::FileName(after.name())).exec();
    CreateView(database, "fits_before", "main");
    CreateView(database, "fits_after", "other");
    database.exec(kPairRuns);
    StoreComparison comparison;
    CompareFits(database, comparison);
    {
      SQLite::Statement parameters(database, kParameters);
      while (parameters.executeStep()) CompareParameter(parameters, comparison);
    }
    std::ranges::sort(comparison.most_moved, std::greater(), &MovedParameter::errors);
    comparison.cpus_before = CpusOf(database, "main");
    comparison.cpus_after = CpusOf(database, "other");
    database.exec(kDropPairs);
    return comparison;
  });
}

}  // namespace pendulum
