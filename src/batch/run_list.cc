// SPDX-License-Identifier: Apache-2.0
#include "batch/run_list.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "batch/entry_row.h"
#include "batch/run_kinds.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMostRuns = 500;

/// Columns 0 to 8 are those of EntryOf.
const std::string kRunRows = R"sql(
WITH listed AS (SELECT *, coalesce(recommended,
    (SELECT min(model) FROM fits WHERE fits.run = runs.run AND fits.stale IS NULL HAVING count(*) = 1)) AS law
  FROM runs WHERE NOT )sql" + kIsUnlisted +
                             R"sql(
  ORDER BY exit_code > 0 DESC, stale IS NULL, id IN (SELECT value FROM json_each(?)) DESC, news IS NULL, position, id
  LIMIT ?)
SELECT listed.position, id, path, rig, calibration, from_s, to_s, models, columns, exit_code, listed.stale,
    coalesce(sentence, listed.reason), law, fitted, news, )sql" +
                             kIsMissing + R"sql(, fits.verdict,
    (SELECT json_extract(fit.value, '$.summary.level') FROM json_each(result, '$.fits') AS fit
      WHERE json_extract(fit.value, '$.model') = law)
  FROM listed LEFT JOIN fits ON fits.run = listed.run AND fits.model = law ORDER BY listed.position, id)sql";

/// Words for the end of a run.
struct RunEnd {
  std::string level, words, why;
};

RunEnd EndOf(const SQLite::Statement& row, const std::string& difference) {
  const std::string why = sqlite::Text(row, 11), verdict = sqlite::Text(row, 16);
  if (!row.getColumn(10).isNull()) return {"bad", "former result only", why.empty() ? sqlite::Text(row, 10) : why};
  if (row.getColumn(9).isNull()) return {"waiting", "not fitted yet", ""};
  const int exit_code = row.getColumn(9).getInt();
  if (row.getColumn(15).getInt() == 1) return {"bad", "missing", why};
  if (exit_code > 1) return {"bad", "refused", why};
  if (exit_code == 1) return {"bad", "not converged", verdict};
  if (!difference.empty()) return {"caution", "disagrees with the others", difference};
  if (sqlite::Text(row, 12).empty()) return {"caution", "no law recommended", ""};
  const std::string level = sqlite::Text(row, 17);
  if (level == "caution" || level == "bad") return {"caution", "fitted, with doubts", verdict};
  return {"good", "fitted", verdict};
}

/// A path of the manifest from where the refit was started.
std::string InFolder(const std::string& folder, const std::string& path) {
  return (std::filesystem::path(folder) / path).lexically_normal().string();
}

/// A number that reads back as the same.
std::optional<std::string> ExactText(const std::optional<double>& value) {
  return value ? std::optional(NumberText(*value)) : std::nullopt;
}

/// The name of the report of a run, in the present folder: "a.html" for "runs/a.csv".
std::string ReportName(const std::string& path) { return std::filesystem::path(path).stem().string() + ".html"; }

/// The command that fits one run of the batch again and writes its report; empty if the flags are not known.
std::string CommandOf(const ManifestEntry& entry, const StoreMeta& meta) {
  Json flags = Json::parse(meta.flags, nullptr, false);
  if (!flags.is_object()) return "";
  const auto set = [&](const char* name, const std::string& value) {
    if (!value.empty()) flags[name] = value;
  };
  set("rig", entry.rig.empty() ? "" : InFolder(meta.folder, entry.rig));
  set("calibration", entry.calibration.empty() ? "" : InFolder(meta.folder, entry.calibration));
  set("from", ExactText(entry.from).value_or(""));
  set("to", ExactText(entry.to).value_or(""));
  set("model", entry.models);
  std::string command = "fit_pendulum " + ShellWord(InFolder(meta.folder, entry.path));
  for (const auto& [name, value] : flags.items()) {
    command += " --" + name + (value.is_string() ? " " + ShellWord(value.get<std::string>()) : "");
  }
  return command + " --report " + ShellWord(ReportName(entry.path));
}

/// Runs that need a look have a low rank.
std::ptrdiff_t RankOf(const ListedRun& run) {
  constexpr std::array<std::string_view, 3> kLevels = {"bad", "caution", "waiting"};
  const std::ptrdiff_t level = std::ranges::find(kLevels, run.level) - kLevels.begin();
  return 2 * level + (run.news.empty() ? 1 : 0);
}

std::string NewsText(std::int64_t runs, const RefitNews& news) {
  const std::int64_t rest = runs - news.fresh - news.again;
  const auto verb = [](std::int64_t count) { return std::to_string(count) + (count == 1 ? " is" : " are"); };
  if (news.fresh == 0 && news.again == 0) return "Nothing is new: the last refit fitted no recording.";
  if (news.fresh == runs)
    return runs == 1 ? "The recording is new." : "All " + std::to_string(runs) + " recordings are new.";
  std::vector<std::string> parts;
  if (news.fresh > 0) parts.push_back(verb(news.fresh) + " new");
  if (news.again > 0)
    parts.push_back(std::to_string(news.again) + (news.again == 1 ? " was" : " were") + " fitted again");
  if (rest > 0) parts.push_back(verb(rest) + " as before");
  return "Since the refit before: of " + std::to_string(runs) + (runs == 1 ? " recording, " : " recordings, ") +
         ListWithAnd(parts) + ".";
}

}  // namespace

RefitNews NewsOf(SQLite::Database& database, const StoreMeta& meta) {
  RefitNews news{.began = meta.began, .ended = meta.ended};
  if (meta.began.empty()) return news;
  SQLite::Statement row(database,
                        "SELECT count(*), count(*) FILTER (WHERE news = 'new'), count(*) FILTER (WHERE news = 'again') "
                        "FROM runs WHERE position >= 0 AND run NOT IN (SELECT run FROM requests)");
  row.executeStep();
  news.fresh = row.getColumn(1).getInt64();
  news.again = row.getColumn(2).getInt64();
  news.text = NewsText(row.getColumn(0).getInt64(), news);
  return news;
}

std::vector<ListedRun> ListRuns(SQLite::Database& database, const StoreMeta& meta,
                                const std::map<std::string, std::string>& outliers) {
  SQLite::Statement rows(database, kRunRows);
  Json ids = Json::array();
  for (const auto& [id, difference] : outliers) ids.push_back(id);
  sqlite::Bind(rows, JsonText(ids), kMostRuns);
  std::vector<ListedRun> runs;
  while (rows.executeStep()) {
    const ManifestEntry entry = EntryOf(rows);
    const auto found = outliers.find(entry.id);
    auto [level, words, why] = EndOf(rows, found == outliers.end() ? "" : found->second);
    const bool has_file = words != "missing";
    runs.push_back({entry.id, std::move(level), std::move(words), std::move(why), sqlite::Text(rows, 12),
                    sqlite::Text(rows, 13), sqlite::Text(rows, 14), has_file ? CommandOf(entry, meta) : ""});
  }
  std::ranges::stable_sort(runs, {}, RankOf);
  return runs;
}

}  // namespace pendulum
