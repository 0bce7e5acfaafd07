// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/overview.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "batch/run_kinds.h"
#include "batch/sqlite.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMaxExamples = 10;

Json ModelsJson(SQLite::Database& database) {
  SQLite::Statement rows(database, R"sql(
SELECT model, count(*), count(*) FILTER (WHERE status = 'converged'), count(*) FILTER (WHERE status = 'not_converged'),
    count(*) FILTER (WHERE status = 'not_identifiable'), count(*) FILTER (WHERE status = 'failed')
  FROM fits JOIN runs USING(run) WHERE )sql" +
                                       kIsLiveFit + " GROUP BY model ORDER BY model");
  Json models = Json::array();
  while (rows.executeStep()) {
    models.push_back({{"model", sqlite::Text(rows, 0)},
                      {"fits", rows.getColumn(1).getInt64()},
                      {"converged", rows.getColumn(2).getInt64()},
                      {"not_converged", rows.getColumn(3).getInt64()},
                      {"not_identifiable", rows.getColumn(4).getInt64()},
                      {"failed", rows.getColumn(5).getInt64()}});
  }
  return models;
}

/// Number of recommendations of each model, among runs with several models.
Json RecommendationsJson(SQLite::Database& database) {
  SQLite::Statement rows(database, R"sql(
SELECT recommended, count(*) FROM runs
  WHERE result IS NOT NULL AND run IN (SELECT run FROM fits WHERE stale IS NULL GROUP BY run HAVING count(*) > 1) AND )sql" +
                                       kIsLive + " GROUP BY recommended ORDER BY count(*) DESC, recommended");
  Json list = Json::array();
  while (rows.executeStep()) {
    const bool none = rows.getColumn(0).isNull();
    list.push_back(
        {{"model", none ? Json(nullptr) : Json(sqlite::Text(rows, 0))}, {"runs", rows.getColumn(1).getInt64()}});
  }
  return list;
}

/// A reason without the name of the recording and its line.
std::string ReasonOf(std::string reason, const std::string& path) {
  if (reason.starts_with(path)) reason.erase(0, path.size());
  const std::size_t begin = reason.find_first_not_of(":0123456789 ");
  return reason.erase(0, std::min(begin, reason.size()));
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

struct Failures {
  std::int64_t fits = 0;
  std::string reason;   ///< Reason of the first run, with numbers.
  bool differ = false;  ///< Other runs have other numbers in their reason.
  std::vector<std::string> models, examples;
};

Json FailuresJson(SQLite::Database& database) {
  SQLite::Statement rows(database, R"sql(
SELECT fits.status, exit_code, fits.reason, path, fits.model, id FROM fits JOIN runs USING(run)
  WHERE fits.status <> 'converged' AND )sql" +
                                       kIsLiveFit + " ORDER BY position, id");
  std::map<std::tuple<std::string, int, std::string>, Failures> kinds;
  while (rows.executeStep()) {
    const std::string why = ReasonOf(sqlite::Text(rows, 2), sqlite::Text(rows, 3));
    Failures& failures = kinds[{sqlite::Text(rows, 0), rows.getColumn(1).getInt(), KindOf(why)}];
    if (failures.fits++ == 0) failures.reason = why;
    failures.differ = failures.differ || failures.reason != why;
    const std::string model = sqlite::Text(rows, 4), id = sqlite::Text(rows, 5);
    if (std::ranges::find(failures.models, model) == failures.models.end()) failures.models.push_back(model);
    const bool known = std::ranges::find(failures.examples, id) != failures.examples.end();
    if (!known && failures.examples.size() < kMaxExamples) failures.examples.push_back(id);
  }
  std::vector<Json> list;
  for (const auto& [kind, failures] : kinds) {
    const auto& [status, exit_code, words] = kind;
    list.push_back({{"status", status},
                    {"exit_code", exit_code},
                    {"reason", failures.differ ? words : failures.reason},
                    {"fits", failures.fits},
                    {"models", failures.models},
                    {"examples", failures.examples}});
  }
  std::ranges::stable_sort(list, [](const Json& a, const Json& b) { return a["fits"] > b["fits"]; });
  return list;
}

}  // namespace

Result<Json> Overview(Store& store) {
  return sqlite::Guard(store.name(), [&]() -> Result<Json> {
    SQLite::Database& database = store.database();
    return Json{{"models", ModelsJson(database)},
                {"recommendations", RecommendationsJson(database)},
                {"failures", FailuresJson(database)}};
  });
}

}  // namespace pendulum
