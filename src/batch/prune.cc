// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/prune.h"

#include "batch/run_kinds.h"
#include "batch/sqlite.h"
#include "pendulum/base/try.h"

namespace pendulum {

Result<Prunable> FindPrunable(Store& store) {
  return sqlite::Guard(store.name(), [&]() -> Result<Prunable> {
    SQLite::Database& database = store.database();
    Prunable found;
    found.stale_runs = sqlite::Texts(database, "SELECT id FROM runs WHERE " + kIsStale + " ORDER BY position, id");
    found.unlisted_runs = sqlite::Texts(database, "SELECT id FROM runs WHERE " + kIsUnlisted + " ORDER BY id");
    SQLite::Statement models(
        database, "SELECT model, count(*) FROM fits JOIN runs USING(run) WHERE fits.stale IS NOT NULL AND " + kIsLive +
                      " GROUP BY model ORDER BY model");
    while (models.executeStep()) {
      found.models.emplace_back(sqlite::Text(models, 0), models.getColumn(1).getInt64());
    }
    ASSIGN_OR_RETURN(const auto meta, store.Meta());
    // An interrupted refit has marked results that it has not reached yet, and has not recognized all renamed runs.
    const bool is_empty = found.stale_runs.empty() && found.unlisted_runs.empty() && found.models.empty();
    if (meta.is_interrupted() && !is_empty) {
      return ErrorAt(StatusCode::kFailedPrecondition, store.name(),
                     std::string(kNotComplete) +
                         ", so results that it has not replaced yet would be lost. Finish the refit first: run "
                         "refit_pendulums with the same arguments again");
    }
    return found;
  });
}

Result<Prunable> Prune(Store& store) {
  RETURN_IF_ERROR(store.BeginWrite());
  auto found = FindPrunable(store);
  if (!found) {
    store.Rollback();
    return found;
  }
  auto removed = sqlite::Guard(store.name(), [&]() -> Result<void> {
    SQLite::Database& database = store.database();
    if (!found->stale_runs.empty()) database.exec("UPDATE meta SET value = '0' WHERE key = 'complete'");
    database.exec("CREATE TEMP TABLE leaving AS SELECT run FROM runs WHERE " + kIsStale + " OR " + kIsUnlisted);
    database.exec(R"sql(
DELETE FROM quantities WHERE (run, model) IN
  (SELECT run, model FROM fits WHERE stale IS NOT NULL OR run IN (SELECT run FROM leaving));
DELETE FROM fits WHERE stale IS NOT NULL OR run IN (SELECT run FROM leaving);
DELETE FROM runs WHERE run IN (SELECT run FROM leaving);
DROP TABLE leaving)sql");
    return {};
  });
  if (removed) removed = store.Commit();
  return removed ? found : tl::unexpected(removed.error());
}

}  // namespace pendulum
