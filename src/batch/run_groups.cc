// SPDX-License-Identifier: Apache-2.0
#include "batch/run_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "batch/run_kinds.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

/// Manifest columns that have their own column in table runs.
constexpr std::array<std::string_view, 7> kOwnColumns = {"id",     "path", "rig",   "calibration",
                                                         "from_s", "to_s", "models"};

/// Columns whose name says that they tell pendulums apart.
constexpr std::array<std::string_view, 3> kPendulumColumns = {"pendulum", "group", "rig_id"};

/// Columns of simulate_pendulum's manifest with the truth; a start is not of the pendulum.
constexpr std::string_view kTruth = "true_";

/// The parameters that say whether runs are of one pendulum, their words and the largest scatter of repeats.
struct Limit {
  std::string_view name, words;
  double scatter;
};
constexpr std::array<Limit, 4> kLimits = {{{"small_angle_period", "period", 0.01},
                                           {"inertia", "inertia", 0.02},
                                           {"viscous", "viscous friction", 0.5},
                                           {"coulomb", "dry friction", 0.5}}};
constexpr double kClearly = 10;  // standard errors

std::string SqlText(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

/// Runs that have no rig, neither of their own nor of the batch. The values of some parameters have other units.
const std::string kHasNoRig = "(runs.rig = '' AND coalesce(rig_sha256, '') = '')";

bool HasColumn(SQLite::Database& database, const std::string& column) {
  if (std::ranges::find(kOwnColumns, column) != kOwnColumns.end()) return true;
  const std::vector<std::string> known = sqlite::Texts(database, sqlite::kManifestColumns);
  return std::ranges::find(known, column) != known.end();
}

std::int64_t CountDistinct(SQLite::Database& database, const std::string& sql) {
  return database.execAndGet("SELECT count(DISTINCT " + sql + ") FROM runs WHERE " + kIsLive).getInt64();
}

constexpr const char* kFolderSql = "rtrim(path, replace(path, '/', ''))";

/// SQL for the true values of the pendulum; empty if the manifest has none.
std::string TrueValuesSql(SQLite::Database& database) {
  std::string keys;
  for (const std::string& column : sqlite::Texts(database, sqlite::kManifestColumns)) {
    if (!column.starts_with(kTruth) || !IsOfTheRig(column.substr(kTruth.size()))) continue;
    keys += (keys.empty() ? "" : ", ") + SqlText(column);
  }
  if (keys.empty()) return "";
  return "coalesce((SELECT group_concat(substr(key, 6) || ' ' || value, ', ') FROM json_each(columns) WHERE key IN (" +
         keys + ")), '')";
}

/// Whether some folder has several recordings, and there are several folders.
bool HasFoldersOfSeveral(SQLite::Database& database) {
  if (CountDistinct(database, kFolderSql) < 2) return false;
  return database
             .execAndGet("SELECT max(n) FROM (SELECT count(*) AS n FROM runs WHERE " + kIsLive + " GROUP BY " +
                         kFolderSql + ")")
             .getInt64() > 1;
}

/// A run without a value in the column is a group by itself: nothing says which pendulum it is of.
RunGroups ByColumn(const std::string& column) {
  return {.by = column == "rig" ? RunGroups::By::kRig : RunGroups::By::kColumn,
          .name = column,
          .sql = "coalesce(nullif(" + ColumnSql(column) + ", ''), " + SqlText("no " + column + ": ") + " || runs.id)"};
}

RunGroups Choose(SQLite::Database& database, const std::string& group_by) {
  if (!group_by.empty()) {
    RunGroups groups;
    if (HasColumn(database, group_by)) {
      groups = ByColumn(group_by);
    } else if (group_by == "folder") {
      groups = {.by = RunGroups::By::kFolder, .name = "folder", .sql = kFolderSql};
    }
    groups.is_stated = true;
    return groups;
  }
  for (const std::string_view column : kPendulumColumns) {
    const std::string name(column);
    if (!HasColumn(database, name) || CountDistinct(database, ColumnSql(name)) < 2) continue;
    RunGroups groups = ByColumn(name);
    groups.is_stated = true;
    return groups;
  }
  if (const std::string truth = TrueValuesSql(database); !truth.empty() && CountDistinct(database, truth) > 1) {
    return {.by = RunGroups::By::kTrueValues, .name = "true values", .sql = truth, .is_stated = true};
  }
  const std::int64_t rigs =
      database.execAndGet("SELECT count(DISTINCT rig) FROM runs WHERE rig <> '' AND " + kIsLive).getInt64();
  if (rigs > 1) return ByColumn("rig");
  const bool has_rig =
      database.execAndGet("SELECT count(*) FROM runs WHERE coalesce(rig_sha256, '') <> '' AND " + kIsLive).getInt() > 0;
  if (!has_rig && HasFoldersOfSeveral(database)) {
    return {.by = RunGroups::By::kFolder, .name = "folder", .sql = kFolderSql};
  }
  RunGroups groups;
  const std::string without = "SELECT count(*) FROM runs WHERE rig = '' AND " + kIsFitted;
  if (rigs == 1 && database.execAndGet(without).getInt64() > 0) {
    return {.by = RunGroups::By::kRig,
            .name = "rig",
            .sql = "iif(" + kHasNoRig + ", 'no rig', coalesce(nullif(runs.rig, ''), '--rig'))"};
  }
  if (rigs == 1)
    groups.one_rig = sqlite::Texts(database, "SELECT DISTINCT rig FROM runs WHERE rig <> '' AND " + kIsLive).front();
  return groups;
}

/// The robust standard deviation of values over their median.
double RelativeScatter(const std::vector<double>& values) { return RobustStdDev(values) / std::abs(MedianOf(values)); }

const Limit* LimitOf(std::string_view parameter) {
  const auto* const found = std::ranges::find(kLimits, parameter, &Limit::name);
  return found == kLimits.end() ? nullptr : found;
}

/// The values of a parameter by group and unit.
std::map<std::pair<std::string, std::string>, RunValues> ValuesByGroup(SQLite::Database& database,
                                                                       const std::string& model, std::string_view name,
                                                                       const RunGroups& groups) {
  SQLite::Statement rows(database, "SELECT " + groups.sql + R"sql(, estimate, std_error, unit
  FROM runs JOIN fits USING(run) JOIN quantities USING(run, model)
  WHERE model = ? AND name = ? AND status = 'converged' AND fixed = 0 AND estimate IS NOT NULL AND std_error > 0
    AND )sql" + kIsLiveFit + " AND " + groups.condition);
  sqlite::Bind(rows, model, std::string(name));
  std::map<std::pair<std::string, std::string>, RunValues> values;
  while (rows.executeStep()) {
    RunValues& own = values[{sqlite::Text(rows, 0), sqlite::Text(rows, 3)}];
    own.estimate.push_back(rows.getColumn(1).getDouble());
    own.std_error.push_back(rows.getColumn(2).getDouble());
  }
  return values;
}

std::string Count(std::int64_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string PercentText(double share) {
  const double percent = 100 * share;
  return (percent < 100 ? NumberText(percent, 2) : std::to_string(std::lround(percent))) + " %";
}

/// What the runs of one group have in common.
std::string SharedWords(const RunGroups& groups) {
  switch (groups.by) {
    case RunGroups::By::kRig: return "the same rig file";
    case RunGroups::By::kTrueValues: return "the same true values";
    case RunGroups::By::kFolder: return "the same folder";
    default: return "the same value in the column " + groups.name;
  }
}

/// Sets the numbers of a grouping, and the groups whose runs have different sources.
void CountGroups(SQLite::Database& database, RunGroups& groups) {
  const std::string fitted = kIsFitted + " AND " + groups.condition;
  SQLite::Statement sizes(database,
                          "SELECT coalesce(sum(n), 0), count(*), coalesce(min(n), 0), coalesce(max(n), 0) FROM (SELECT "
                          "count(*) AS n FROM runs WHERE " +
                              fitted + " GROUP BY " + groups.sql + ")");
  sizes.executeStep();
  groups.runs = sizes.getColumn(0).getInt64();
  groups.groups = sizes.getColumn(1).getInt64();
  groups.smallest = sizes.getColumn(2).getInt64();
  groups.largest = sizes.getColumn(3).getInt64();
  const std::int64_t without_rig =
      database.execAndGet("SELECT count(*) FROM runs WHERE " + kHasNoRig + " AND " + fitted).getInt64();
  if (without_rig < groups.runs) groups.without_rig = without_rig;
  const std::vector<std::string> own = sqlite::Texts(
      database,
      "SELECT pendulum FROM (SELECT " + groups.sql + " AS pendulum, sources FROM runs WHERE " + kIsLive + " AND " +
          groups.condition +
          " AND run IN (SELECT run FROM fits WHERE status = 'converged' AND stale IS NULL)) GROUP BY pendulum HAVING "
          "count(DISTINCT sources) > 1");
  groups.own_sources.insert(own.begin(), own.end());
}

}  // namespace

bool IsWayToGroup(const std::string& group_by) { return group_by == "all" || group_by == "folder"; }

std::string ColumnSql(const std::string& column) {
  if (std::ranges::find(kOwnColumns, column) != kOwnColumns.end()) return "runs." + column;
  return "(SELECT value FROM json_each(columns) WHERE key = " + SqlText(column) + ")";
}

RunGroups GroupRuns(SQLite::Database& database, const std::string& group_by) {
  RunGroups groups = Choose(database, group_by);
  CountGroups(database, groups);
  return groups;
}

RunGroups GroupBatch(SQLite::Database& database, std::int64_t batch) {
  RunGroups groups;
  groups.condition = "runs.run IN (SELECT run FROM requests WHERE batch = " + std::to_string(batch) + ")";
  CountGroups(database, groups);
  return groups;
}

bool DifferGrossly(const std::string& parameter, const RunValues& values) {
  const Limit* const limit = LimitOf(parameter);
  if (limit == nullptr || values.size() < 2) return false;
  const double scatter = RelativeScatter(values.estimate);
  return scatter > limit->scatter &&
         scatter * std::abs(MedianOf(values.estimate)) > kClearly * MedianOf(values.std_error);
}

void FindUnlikeGroups(SQLite::Database& database, const std::string& model, RunGroups& groups) {
  if (groups.is_stated || groups.largest < 2) return;
  double worst = 0;
  for (const Limit& limit : kLimits) {
    for (const auto& [key, values] : ValuesByGroup(database, model, limit.name, groups)) {
      const std::string& group = key.first;
      if (!DifferGrossly(std::string(limit.name), values)) continue;
      if (std::ranges::find(groups.unlike, group) == groups.unlike.end()) groups.unlike.push_back(group);
      const double scatter = RelativeScatter(values.estimate);
      if (scatter / limit.scatter <= worst) continue;
      worst = scatter / limit.scatter;
      groups.difference = std::string(limit.words) + " scatters by " + PercentText(scatter) +
                          ", but between repeats of one pendulum by at most " + PercentText(limit.scatter);
    }
  }
}

namespace {

/// What was taken for one pendulum, apart from runs without a rig.
std::string GroupingText(const RunGroups& groups) {
  if (groups.runs == 0) return "No recording is fitted, so there is nothing to compare.";
  if (groups.runs == 1) return "One recording is fitted; repeatability needs several recordings of one pendulum.";
  const std::string all = std::to_string(groups.runs) + " recordings";
  if (groups.largest == 1) {
    return std::to_string(groups.groups) + " different pendulums" +
           (groups.by == RunGroups::By::kTrueValues ? " (each has its own true values)"
                                                    : " (each has its own " + groups.name + ")") +
           "; repeatability needs several recordings of one.";
  }
  if (groups.by == RunGroups::By::kAll) {
    if (!groups.unlike.empty()) {
      return "The " + all + " are not taken for one pendulum: their " + groups.difference +
             ". So they are not compared, and nothing is concluded about their errors.";
    }
    const std::string why = groups.is_stated          ? "as --group_by all says"
                            : !groups.one_rig.empty() ? "they have the same rig file, " +
                                                            std::filesystem::path(groups.one_rig).filename().string()
                                                      : "nothing says otherwise";
    return "The " + all + " are taken for repeats of one pendulum: " + why + ".";
  }
  const std::string sizes = groups.smallest == groups.largest ? std::to_string(groups.largest) + " recordings each"
                                                              : std::to_string(groups.smallest) + " to " +
                                                                    std::to_string(groups.largest) + " recordings each";
  std::string text = "Recordings with " + SharedWords(groups) +
                     " are taken for repeats of one pendulum: " + Count(groups.groups, "pendulum") + ", " + sizes + ".";
  if (!groups.unlike.empty()) {
    text += groups.unlike.size() == 1
                ? " The recordings of one pendulum (" + groups.unlike.front() + ") are not compared: their "
                : " The recordings of " + std::to_string(groups.unlike.size()) +
                      " pendulums are not compared, because they differ too much for repeats: of one of these "
                      "pendulums, the ";
    text += groups.difference + ".";
  }
  return text;
}

}  // namespace

std::string GroupsText(const RunGroups& groups) {
  std::string text = GroupingText(groups);
  if (groups.without_rig == 0) return text;
  return text + (groups.without_rig == 1 ? " One recording has no rig, so its values have other units; it is not "
                                           "compared with the recordings that have a rig."
                                         : " " + std::to_string(groups.without_rig) +
                                               " recordings have no rig, so their values have other units; they are "
                                               "not compared with the recordings that have a rig.");
}

std::string OtherGroupsText(const RunGroups& groups) {
  if (groups.runs < 2) return "";
  if (groups.by == RunGroups::By::kAll && groups.unlike.empty()) {
    return "If they are of several, name the column of the manifest that tells the pendulums apart: --group_by COLUMN. "
           "If each is of another pendulum: --group_by id.";
  }
  if (groups.by == RunGroups::By::kAll) {
    return "If they are of one pendulum: --group_by all. If a column of the manifest tells the pendulums apart: "
           "--group_by COLUMN.";
  }
  return "If another column tells the pendulums apart: --group_by COLUMN. If all are of one: --group_by all.";
}

}  // namespace pendulum
