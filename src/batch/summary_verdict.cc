// SPDX-License-Identifier: Apache-2.0
#include "batch/summary_verdict.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "batch/run_kinds.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

constexpr int kExamples = 10;

std::vector<RunCounts::Run> ExamplesOf(SQLite::Database& database, const std::string& condition) {
  SQLite::Statement rows(database, "SELECT id, iif(place = path, sentence, coalesce(stale, reason)) FROM runs WHERE " +
                                       condition + " ORDER BY position, id LIMIT " + std::to_string(kExamples));
  std::vector<RunCounts::Run> runs;
  while (rows.executeStep()) runs.push_back({sqlite::Text(rows, 0), sqlite::Text(rows, 1)});
  return runs;
}

/// "inertia, viscous and 3 more".
std::string NamesText(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 3;
  if (names.size() <= kNamed) return NameList(names);
  return NameList(std::vector<std::string>(names.begin(), names.begin() + kNamed - 1)) + " and " +
         std::to_string(names.size() - kNamed + 1) + " more";
}

std::string CountsText(const RunCounts& counts) {
  std::string text = std::to_string(counts.fitted) + " of " + std::to_string(counts.runs) +
                     (counts.runs == 1 ? " recording fitted" : " recordings fitted");
  std::string rest;
  for (const auto& [count, words] :
       {std::pair{counts.missing, "missing"}, std::pair{counts.without_rig_file, "with a missing rig or calibration"},
        std::pair{counts.refused - counts.without_rig_file, "refused"},
        std::pair{counts.not_converged, "not converged"}, std::pair{counts.pending, "not fitted yet"},
        std::pair{counts.stale, "with a former result only"},
        std::pair{counts.unlisted, "more left out, not among the recordings of the last refit"}}) {
    if (count > 0) rest += (rest.empty() ? "; " : ", ") + std::to_string(count) + " " + words;
  }
  return text + rest + (counts.is_complete ? "" : "; " + std::string(kNotComplete));
}

}  // namespace

RunCounts CountRuns(SQLite::Database& database, const StoreMeta& meta) {
  const std::string live = " AND " + kIsLive;
  const std::string missing = kIsMissing + live;
  const std::string refused = "exit_code > 1 AND NOT " + kIsMissing + live;
  RunCounts counts;
  counts.is_complete = !meta.is_interrupted();
  const std::array<std::pair<std::string, std::int64_t*>, 9> all = {
      {{"NOT " + kIsUnlisted, &counts.runs},
       {kIsFitted, &counts.fitted},
       {"exit_code = 1" + live, &counts.not_converged},
       {missing, &counts.missing},
       {refused, &counts.refused},
       {kLacksFile + " AND NOT " + kIsMissing, &counts.without_rig_file},
       {"exit_code IS NULL" + live, &counts.pending},
       {kIsStale, &counts.stale},
       {kIsUnlisted, &counts.unlisted}}};
  std::string columns;
  for (const auto& [condition, count] : all) {
    columns += (columns.empty() ? "" : ", ") + ("count(*) FILTER (WHERE " + condition + ")");
  }
  SQLite::Statement row(database, "SELECT " + columns + " FROM runs");
  row.executeStep();
  for (std::size_t i = 0; i < all.size(); ++i) *all.at(i).second = row.getColumn(static_cast<int>(i)).getInt64();
  counts.missing_runs = ExamplesOf(database, missing);
  counts.refused_runs = ExamplesOf(database, refused);
  counts.stale_runs = ExamplesOf(database, kIsStale);
  counts.text = CountsText(counts);
  return counts;
}

std::string MainLaw(SQLite::Database& database, const StoreOverview& overview, const RunGroups& groups) {
  SQLite::Statement laws(database, "WITH laws AS (SELECT " + groups.sql + R"sql( AS pendulum, coalesce(recommended,
    (SELECT min(model) FROM fits WHERE fits.run = runs.run AND fits.stale IS NULL HAVING count(*) = 1)) AS law FROM runs WHERE )sql" +
                                       kIsFitted + " AND " + groups.condition + R"sql()
SELECT law FROM laws WHERE law IS NOT NULL AND
    (?1 < 2 OR pendulum IN (SELECT pendulum FROM laws GROUP BY pendulum HAVING count(*) > 1))
  GROUP BY law ORDER BY count(*) DESC, law LIMIT 1)sql");
  sqlite::Bind(laws, groups.largest);
  if (laws.executeStep()) return sqlite::Text(laws, 0);
  for (const LawCounts& law : overview.laws) {
    if (law.converged > 0) return law.law;
  }
  return overview.laws.empty() ? "" : overview.laws.front().law;
}

ErrorVerdict VerdictOf(const std::string& law, const std::vector<QuantitySummary>& quantities, const RunGroups& groups,
                       bool left_out) {
  if (!groups.compares()) return {law, "not_compared", "caution", "Whether the errors are right is not known."};
  std::vector<std::string> all, larger, smaller;
  double largest = 0;
  std::string worst;
  bool enough = true;
  for (const QuantitySummary& quantity : quantities) {
    if (quantity.law != law || quantity.is_derived || !quantity.repeatability) continue;
    const Repeatability& found = *quantity.repeatability;
    all.push_back(quantity.name);
    enough = enough && found.HasEnoughRuns();
    if (found.verdict == Repeatability::Verdict::kScatterSmaller) smaller.push_back(quantity.name);
    if (found.verdict != Repeatability::Verdict::kScatterLarger) continue;
    larger.push_back(quantity.name);
    if (found.ScatterRatio() <= largest) continue;
    largest = found.ScatterRatio();
    worst = quantity.name;
  }
  const std::string count = std::to_string(all.size()) + (all.size() == 1 ? " parameter" : " parameters");
  const std::string repeats =
      "Under the law " + law + ", repeats" + (left_out ? " without the outliers" : "") + " differ";
  if (all.empty()) {
    return {law, "not_compared", "caution",
            "Whether the errors are right is not known: no two recordings of one pendulum have a fit with errors."};
  }
  if (!larger.empty()) {
    return {law, "too_small", "caution",
            repeats + " by more than their errors in " + std::to_string(larger.size()) + " of " + count + ": " +
                (larger.size() > 1 ? NamesText(larger) + ". Most of all, " : "") + worst + " scatters " +
                NumberText(largest, 3) +
                " times as much as its errors predict. Either the pendulum changed or the errors are too "
                "small."};
  }
  if (!smaller.empty()) {
    return {law, "too_large", "good",
            repeats + " by less than their errors in " + NamesText(smaller) + ". The errors are not too small."};
  }
  if (!enough) {
    return {law, "few", "good",
            repeats + " as much as their errors say, but they are too few to find a difference below a third."};
  }
  return {law, "agrees", "good",
          repeats + " as much as their errors say, in " + (all.size() == 1 ? "the " + all.front() : "all " + count) +
              ". No difference from the errors was found."};
}

}  // namespace pendulum
