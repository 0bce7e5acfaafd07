// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "batch/sqlite.h"
#include "pendulum/base/format.h"
#include "pendulum/base/version.h"
#include "pendulum/batch/overview.h"
#include "pendulum/batch/run_statistics.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 2;
constexpr int kMaxOutliers = 50;
constexpr std::size_t kMaxPoints = 2000;

Json StoreJson(Store& store, const StoreMeta& meta, const StoreCounts& counts) {
  SQLite::Database& database = store.database();
  return {{"path", store.name()},
          {"runs", counts.runs},
          {"refitted", counts.runs - counts.pending},
          {"pending", counts.pending},
          {"fits", counts.fits},
          {"versions",
           sqlite::Texts(database, "SELECT DISTINCT version FROM runs WHERE version IS NOT NULL ORDER BY version")},
          {"cpus", sqlite::Texts(database, "SELECT DISTINCT cpu FROM runs WHERE cpu IS NOT NULL ORDER BY cpu")},
          {"manifest_sha256", TextOrNull(meta.manifest_sha256)}};
}

/// One parameter or derived quantity of one model, in one unit.
struct Quantity {
  std::string model, name, unit;
};

/// The values of a quantity, and the names of its runs.
struct QuantityRuns {
  RunValues values;
  std::vector<std::string> ids, groups;  ///< `ids`: one per run; `groups`: one per group.
  bool dates = false;
};

/// Manifest columns that have their own column in table runs.
constexpr std::array<std::string_view, 7> kOwnColumns = {"id",     "path", "rig",   "calibration",
                                                         "from_s", "to_s", "models"};

/// SQL for a run's value in a manifest column. The next parameter of the statement must be the column's name.
std::string ValueOf(const std::string& column) {
  const bool own = std::ranges::find(kOwnColumns, column) != kOwnColumns.end();
  return own ? "iif(? = '', NULL, runs." + column + ")" : "(SELECT value FROM json_each(columns) WHERE key = ?)";
}

QuantityRuns RunsOf(SQLite::Database& database, const Quantity& quantity, const SummaryOptions& options) {
  SQLite::Statement rows(database, "SELECT id, position, estimate, std_error, " + ValueOf(options.group_by) + ", " +
                                       ValueOf(options.trend_by) + R"sql(
  FROM runs JOIN fits USING(run) JOIN quantities USING(run, model)
  WHERE model = ? AND name = ? AND unit = ? AND status = 'converged' AND fixed = 0 AND estimate IS NOT NULL
  ORDER BY position, id)sql");
  sqlite::Bind(rows, options.group_by, options.trend_by, quantity.model, quantity.name, quantity.unit);
  QuantityRuns runs;
  std::map<std::string, std::size_t> groups;
  while (rows.executeStep()) {
    runs.ids.push_back(sqlite::Text(rows, 0));
    runs.values.estimate.push_back(rows.getColumn(2).getDouble());
    const bool has_error = !rows.getColumn(3).isNull();
    runs.values.std_error.push_back(has_error ? rows.getColumn(3).getDouble()
                                              : std::numeric_limits<double>::quiet_NaN());
    const std::string group = options.group_by.empty() ? "" : sqlite::Text(rows, 4);
    const auto [known, is_new] = groups.emplace(group, groups.size());
    if (is_new) runs.groups.push_back(group);
    runs.values.group.push_back(known->second);
    std::optional<double> order;
    if (const double position = rows.getColumn(1).getDouble(); position >= 0) order = position;
    bool is_date = false;
    if (!options.trend_by.empty()) order = ParseOrderValue(sqlite::Text(rows, 5), is_date);
    runs.dates = runs.dates || is_date;
    runs.values.order.push_back(order.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return runs;
}

/// A unit after a number; empty for a dimensionless one.
std::string Spaced(const std::string& unit) { return unit == "1" ? "" : " " + unit; }

/// "20 runs scatter 1.03 times as much as their quoted errors predict (p 0.2)".
std::string VerdictText(const Repeatability& all, const std::string& unit, std::size_t outliers) {
  std::string text = std::to_string(all.runs) + " runs scatter " + NumberText(all.ScatterRatio(), 3) +
                     " times as much as their quoted errors predict (p " +
                     ProbabilityText(std::min(all.lower_p, all.upper_p)) + "): ";
  switch (all.verdict) {
    case Repeatability::Verdict::kAgrees: text += "the runs agree with the error bars"; break;
    case Repeatability::Verdict::kScatterLarger:
      text += "the runs differ by ± " + NumberText(all.between, 2) + Spaced(unit) +
              " beyond their errors, or the errors are too small";
      break;
    case Repeatability::Verdict::kScatterSmaller: text += "the errors are too large, or the runs are not independent";
  }
  if (outliers > 0) text += "; " + std::to_string(outliers) + (outliers == 1 ? " outlier" : " outliers") + " left out";
  return text;
}

Json GroupName(const QuantityRuns& runs, const SummaryOptions& options, std::size_t group) {
  return options.group_by.empty() ? Json(nullptr) : Json(runs.groups[group]);
}

Json RepeatabilityJson(const QuantityRuns& runs, const SummaryOptions& options, const Repeatability& all,
                       const std::string& unit, std::size_t outliers) {
  constexpr std::array<const char*, 3> kVerdicts = {"agrees", "scatter_larger", "scatter_smaller"};
  Json rows = Json::array();
  for (const GroupRepeatability& group : all.groups) {
    rows.push_back({{"group", options.group_by.empty() ? "all runs" : runs.groups[group.group]},
                    {"runs", group.runs},
                    {"weighted_mean", group.mean},
                    {"std_error", group.std_error},
                    {"scatter_ratio", group.ScatterRatio()},
                    {"p", group.P()}});
  }
  return {{"groups", all.groups.size()},
          {"runs", all.runs},
          {"dof", all.dof},
          {"chi2", all.chi2},
          {"scatter_ratio", all.ScatterRatio()},
          {"p", std::min(all.lower_p, all.upper_p)},
          {"between_std_dev", all.between},
          {"verdict", kVerdicts.at(static_cast<std::size_t>(all.verdict))},
          {"text", VerdictText(all, unit, outliers)},
          {"rows", rows}};
}

Json OutliersJson(const QuantityRuns& runs, const SummaryOptions& options, const std::vector<Outlier>& outliers) {
  Json list = Json::array();
  for (const Outlier& outlier : outliers) {
    if (list.size() == kMaxOutliers) break;
    list.push_back({{"id", runs.ids[outlier.run]},
                    {"group", GroupName(runs, options, runs.values.group[outlier.run])},
                    {"estimate", runs.values.estimate[outlier.run]},
                    {"std_error", NumberOrNull(runs.values.std_error[outlier.run])},
                    {"z", outlier.z}});
  }
  return list;
}

/// Every n-th point, so that at most kMaxPoints remain.
Json PointsJson(const QuantityRuns& runs, const SummaryOptions& options) {
  Json points = Json::array();
  const std::size_t step = (runs.values.size() + kMaxPoints - 1) / kMaxPoints;
  for (std::size_t i = 0; i < runs.values.size(); i += step) {
    if (!std::isfinite(runs.values.order[i])) continue;
    points.push_back({{"x", runs.values.order[i]},
                      {"y", runs.values.estimate[i]},
                      {"std_error", NumberOrNull(runs.values.std_error[i])},
                      {"id", runs.ids[i]},
                      {"group", GroupName(runs, options, runs.values.group[i])}});
  }
  return points;
}

std::string TrendText(const Trend& trend, const std::string& unit, const std::string& per) {
  constexpr double kLevel = 0.01;
  const std::string slope =
      NumberText(trend.slope, 3) + " ± " + NumberText(trend.std_error, 2) + Spaced(unit) + " " + per;
  return (trend.p < kLevel ? "it changes by " : "no trend: ") + slope + " (p " + ProbabilityText(trend.p) + ")";
}

Json TrendJson(const QuantityRuns& runs, const SummaryOptions& options, const std::string& unit,
               const std::vector<Outlier>& outliers) {
  const auto trend = FitTrend(runs.values, outliers);
  if (!trend) return nullptr;
  const std::string column = options.trend_by.empty() ? "position" : options.trend_by;
  const std::string per = runs.dates ? "per day" : options.trend_by.empty() ? "per run" : "per unit of " + column;
  return {{"column", column},
          {"unit", runs.dates ? Json("days since 1970-01-01") : Json(nullptr)},
          {"slope", trend->slope},
          {"std_error", trend->std_error},
          {"p", trend->p},
          {"text", TrendText(*trend, unit, per)},
          {"points", PointsJson(runs, options)},
          {"points_total", runs.values.size()}};
}

Json DistributionJson(const Quantity& quantity, const RunValues& values) {
  const Distribution distribution = Describe(values.estimate);
  std::vector<double> errors;
  std::ranges::copy_if(values.std_error, std::back_inserter(errors), [](double error) { return std::isfinite(error); });
  return {{"model", quantity.model},
          {"name", quantity.name},
          {"unit", quantity.unit},
          {"runs", values.size()},
          {"median", distribution.median},
          {"mean", distribution.mean},
          {"std_dev", distribution.std_dev},
          {"minimum", distribution.minimum},
          {"maximum", distribution.maximum},
          {"lower_quartile", distribution.lower_quartile},
          {"upper_quartile", distribution.upper_quartile},
          {"median_std_error", errors.empty() ? Json(nullptr) : Json(Describe(errors).median)},
          {"histogram",
           {{"from", distribution.from},
            {"to", distribution.to},
            {"counts", distribution.counts},
            {"below", distribution.below},
            {"above", distribution.above}}}};
}

/// Whether a quantity belongs to the rig; start and zero differ between runs.
bool IsOfTheRig(const Quantity& quantity) {
  constexpr std::array<std::string_view, 8> kOfTheRun = {"release_angle", "release_time", "initial_angle",
                                                         "initial_rate",  "zero_angle",   "rate_bias",
                                                         "zero_drift",    "bias_drift"};
  return std::ranges::find(kOfTheRun, quantity.name) == kOfTheRun.end();
}

Json QuantityJson(SQLite::Database& database, const Quantity& quantity, const SummaryOptions& options) {
  const QuantityRuns runs = RunsOf(database, quantity, options);
  if (runs.values.size() == 0) return nullptr;
  const bool of_the_rig = IsOfTheRig(quantity);
  const std::vector<Outlier> outliers = of_the_rig ? FindOutliers(runs.values) : std::vector<Outlier>();
  const auto repeatability = of_the_rig ? AnalyzeRepeatability(runs.values, outliers) : std::nullopt;
  Json json = DistributionJson(quantity, runs.values);
  json["repeatability"] =
      repeatability ? RepeatabilityJson(runs, options, *repeatability, quantity.unit, outliers.size()) : Json(nullptr);
  const char* reason = of_the_rig ? "no group has two runs with an error"
                                  : "it depends on how each run begins, so it is not a constant of the rig";
  json["repeatability_reason"] = repeatability ? Json(nullptr) : Json(reason);
  json["outliers"] = OutliersJson(runs, options, outliers);
  json["outliers_total"] = outliers.size();
  json["trend"] = TrendJson(runs, options, quantity.unit, outliers);
  return json;
}

Json QuantitiesJson(SQLite::Database& database, const SummaryOptions& options) {
  SQLite::Statement rows(database, R"sql(
SELECT model, name, unit FROM quantities GROUP BY model, name, unit ORDER BY model, min(derived), name, unit)sql");
  Json list = Json::array();
  while (rows.executeStep()) {
    Json json = QuantityJson(database, {sqlite::Text(rows, 0), sqlite::Text(rows, 1), sqlite::Text(rows, 2)}, options);
    if (!json.is_null()) list.push_back(std::move(json));
  }
  return list;
}

Result<void> CheckColumn(SQLite::Database& database, const char* flag, const std::string& column) {
  if (column.empty() || std::ranges::find(kOwnColumns, column) != kOwnColumns.end()) return {};
  const std::vector<std::string> known = sqlite::Texts(database, sqlite::kManifestColumns);
  if (std::ranges::find(known, column) != known.end()) return {};
  return Error(StatusCode::kInvalidArgument, std::string(flag) + ": the manifest has no column '" + column + "'" +
                                                 (known.empty() ? ", nor any other" : "; it has " + NameList(known)));
}

bool NamesSeveralRigs(SQLite::Database& database) {
  return database.execAndGet("SELECT count(DISTINCT rig) FROM runs WHERE rig <> ''").getInt() > 1;
}

/// Number of runs whose value in the column is neither a number nor a date, and one such value.
std::pair<std::int64_t, std::string> WithoutOrder(SQLite::Database& database, const std::string& column) {
  std::pair<std::int64_t, std::string> found;
  if (column.empty()) return found;
  SQLite::Statement rows(database, "SELECT " + ValueOf(column) + " FROM runs");
  sqlite::Bind(rows, column);
  while (rows.executeStep()) {
    bool is_date = false;
    const std::string value = sqlite::Text(rows, 0);
    if (ParseOrderValue(value, is_date)) continue;
    if (found.first++ == 0) found.second = value;
  }
  return found;
}

Json WarningsJson(SQLite::Database& database, const StoreCounts& counts, const Json& store,
                  const SummaryOptions& options) {
  Json warnings = Json::array();
  const auto add = [&](const char* code, const std::string& message) {
    warnings.push_back({{"code", code}, {"message", message}});
  };
  if (counts.pending > 0) add("pending", std::to_string(counts.pending) + " runs are not refitted yet");
  if (counts.earlier > 0) {
    add("not_in_the_manifest",
        std::to_string(counts.earlier) + " runs are not in the last manifest; their results belong to earlier ones");
  }
  const std::int64_t same =
      database.execAndGet("SELECT count(data_sha256) - count(DISTINCT data_sha256) FROM runs WHERE exit_code < 2")
          .getInt64();
  if (same > 0) {
    add("same_data",
        std::to_string(same) +
            " runs have the same data as another run; unless their windows differ, one swing counts several times");
  }
  const auto [without, example] = WithoutOrder(database, options.trend_by);
  if (without > 0) {
    add("no_order", "the column " + options.trend_by + " of " + std::to_string(without) +
                        " runs is neither a number nor a date such as 2026-03-01, for example " + Quoted(example) +
                        "; trends leave these runs out");
  }
  if (store["versions"].size() > 1) add("mixed_versions", "the fits come from several versions of the program");
  if (store["cpus"].size() > 1) {
    add("several_cpus", "the fits were made on several types of CPU, whose last bits differ");
  }
  return warnings;
}

}  // namespace

Result<Json> Summarize(Store& store, const SummaryOptions& options) {
  const auto meta = store.Meta();
  if (!meta) return tl::unexpected(meta.error());
  const auto counts = store.Count();
  if (!counts) return tl::unexpected(counts.error());
  if (counts->fits == 0) {
    return Error(StatusCode::kFailedPrecondition, store.name() + ": no run is refitted yet; refit some first");
  }
  return sqlite::Guard(store.name(), [&]() -> Result<Json> {
    SQLite::Database& database = store.database();
    SummaryOptions chosen = options;
    if (chosen.group_by.empty() && NamesSeveralRigs(database)) chosen.group_by = "rig";
    for (const auto& [flag, column] :
         {std::pair{"--group_by", chosen.group_by}, std::pair{"--trend_by", chosen.trend_by}}) {
      if (auto checked = CheckColumn(database, flag, column); !checked) return tl::unexpected(checked.error());
    }
    Json json = {{"schema_version", kSchemaVersion},
                 {"tool", {{"name", "refit_pendulums"}, {"version", kVersion}}},
                 {"store", StoreJson(store, *meta, *counts)},
                 {"group_by", TextOrNull(chosen.group_by)},
                 {"trend_by", TextOrNull(chosen.trend_by)}};
    const auto overview = Overview(store);
    if (!overview) return tl::unexpected(overview.error());
    json.update(*overview);
    json["parameters"] = QuantitiesJson(database, chosen);
    json["warnings"] = WarningsJson(database, *counts, json["store"], chosen);
    return json;
  });
}

}  // namespace pendulum
