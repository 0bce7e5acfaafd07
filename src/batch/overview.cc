// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/overview.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "batch/run_kinds.h"
#include "batch/sqlite.h"

namespace pendulum {
namespace {

constexpr std::size_t kMaxExamples = 10;

std::vector<LawCounts> CountLaws(SQLite::Database& database) {
  SQLite::Statement rows(database, R"sql(
SELECT model, count(*), count(*) FILTER (WHERE status = 'converged'), count(*) FILTER (WHERE status = 'not_converged'),
    count(*) FILTER (WHERE status = 'not_identifiable'), count(*) FILTER (WHERE status = 'failed')
  FROM fits JOIN runs USING(run) WHERE )sql" +
                                       kIsLiveFit + " GROUP BY model ORDER BY model");
  const auto count = [&](int column) { return rows.getColumn(column).getInt64(); };
  std::vector<LawCounts> laws;
  while (rows.executeStep()) laws.push_back({sqlite::Text(rows, 0), count(1), count(2), count(3), count(4), count(5)});
  return laws;
}

std::vector<RecommendationCount> CountRecommendations(SQLite::Database& database) {
  SQLite::Statement rows(database, R"sql(
SELECT recommended, count(*) FROM runs
  WHERE result IS NOT NULL AND run IN (SELECT run FROM fits WHERE stale IS NULL GROUP BY run HAVING count(*) > 1) AND )sql" +
                                       kIsLive + " GROUP BY recommended ORDER BY count(*) DESC, recommended");
  std::vector<RecommendationCount> counts;
  while (rows.executeStep()) counts.push_back({sqlite::Text(rows, 0), rows.getColumn(1).getInt64()});
  return counts;
}

/// A reason with # in place of each number, because numbers differ between runs.
std::string KindOf(const std::string& reason) {
  std::string kind;
  for (const char c : reason) {
    const bool digit = c >= '0' && c <= '9';
    if (digit && kind.ends_with('#')) continue;
    kind += digit ? '#' : c;
  }
  for (std::size_t at = kind.find("#.#"); at != std::string::npos; at = kind.find("#.#")) kind.erase(at, 2);
  return kind;
}

/// Failures are grouped by their reasons without file names and numbers. The reason of a group has the numbers only if
/// they are the same in all its failures.
std::vector<FailureCount> CountFailures(SQLite::Database& database) {
  SQLite::Statement rows(database, R"sql(
SELECT fits.status, exit_code, iif()sql" +
                                       kIsOfRecording + R"sql(, sentence, fits.reason), fits.model, id
  FROM fits JOIN runs USING(run) WHERE fits.status <> 'converged' AND )sql" +
                                       kIsLiveFit + " ORDER BY position, id");
  std::map<std::tuple<std::string, int, std::string>, FailureCount> kinds;
  while (rows.executeStep()) {
    const std::string why = sqlite::Text(rows, 2), kind = KindOf(why);
    FailureCount& failures = kinds[{sqlite::Text(rows, 0), rows.getColumn(1).getInt(), kind}];
    if (failures.fits++ == 0) failures.reason = why;
    if (failures.reason != why) failures.reason = kind;
    const std::string law = sqlite::Text(rows, 3), id = sqlite::Text(rows, 4);
    if (std::ranges::find(failures.laws, law) == failures.laws.end()) failures.laws.push_back(law);
    const bool known = std::ranges::find(failures.examples, id) != failures.examples.end();
    if (!known && failures.examples.size() < kMaxExamples) failures.examples.push_back(id);
  }
  std::vector<FailureCount> list;
  for (auto& [kind, failures] : kinds) {
    failures.status = std::get<0>(kind);
    failures.exit_code = std::get<1>(kind);
    list.push_back(std::move(failures));
  }
  std::ranges::stable_sort(list, std::ranges::greater(), &FailureCount::fits);
  return list;
}

}  // namespace

Result<StoreOverview> Overview(Store& store) {
  return sqlite::Guard(store.name(), [&]() -> Result<StoreOverview> {
    SQLite::Database& database = store.database();
    return StoreOverview{CountLaws(database), CountRecommendations(database), CountFailures(database)};
  });
}

}  // namespace pendulum
