// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "batch/run_agreement.h"
#include "batch/run_groups.h"
#include "batch/run_kinds.h"
#include "batch/sqlite.h"
#include "batch/summary_verdict.h"
#include "pendulum/analysis/separate_estimates.h"
#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/base/try.h"
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
  bool derived = false;
};

/// What a summary needs to know of the runs.
struct Context {
  const RunGroups& groups;
  const std::set<std::string>& outliers;  ///< Ids of runs that disagree in all parameters together.
  std::string trend_by;
};

/// The values of a quantity, and the names of its runs.
struct QuantityRuns {
  RunValues values;
  std::vector<double> std_errors;        ///< Statistical, one per run; NaN if a run has none.
  std::vector<std::string> ids, groups;  ///< `ids`: one per run; `groups`: one per group.
  bool dates = false;
};

double NumberOrNan(const SQLite::Statement& row, int column) {
  const SQLite::Column value = row.getColumn(column);
  return value.isNull() ? std::numeric_limits<double>::quiet_NaN() : value.getDouble();
}

/// The error that makes a run differ from its repeats, as in the test of a joint fit (EstimatesToCompare), from the row
/// of RunsOf.
double RepeatError(const SQLite::Statement& row, bool own_sources) {
  const double std_error = NumberOrNan(row, 3), half_interval = NumberOrNan(row, 6);
  const double noise =
      std_error > 0 && half_interval > 0 ? std_error * IntervalFactor(half_interval / std_error) : std_error;
  const double sources = own_sources ? row.getColumn(8).getDouble() : 0;  // NULL gives 0
  return std::hypot(noise, row.getColumn(7).getDouble(), sources);
}

QuantityRuns RunsOf(SQLite::Database& database, const Quantity& quantity, const Context& context) {
  const std::string trend = context.trend_by.empty() ? "NULL" : ColumnSql(context.trend_by);
  SQLite::Statement rows(database, "SELECT id, position, estimate, std_error, " + context.groups.sql + ", " + trend +
                                       R"sql(,
    (upper95 - lower95) / 2, inconstancy_std_error, source_std_error
  FROM runs JOIN fits USING(run) JOIN quantities USING(run, model)
  WHERE model = ? AND name = ? AND unit = ? AND status = 'converged' AND fixed = 0 AND estimate IS NOT NULL AND )sql" +
                                       kIsLiveFit + " ORDER BY position, id");
  sqlite::Bind(rows, quantity.model, quantity.name, quantity.unit);
  QuantityRuns runs;
  std::map<std::string, std::size_t> groups;
  const std::vector<std::string>& unlike = context.groups.unlike;
  while (rows.executeStep()) {
    runs.ids.push_back(sqlite::Text(rows, 0));
    runs.values.estimate.push_back(rows.getColumn(2).getDouble());
    const std::string group = sqlite::Text(rows, 4);
    runs.std_errors.push_back(NumberOrNan(rows, 3));
    runs.values.std_error.push_back(RepeatError(rows, context.groups.own_sources.contains(group)));
    // A run that is not compared is a group of its own.
    const bool is_unlike = std::ranges::find(unlike, group) != unlike.end();
    const auto [known, is_new] = groups.emplace(is_unlike ? '\0' + runs.ids.back() : group, groups.size());
    if (is_new) runs.groups.push_back(group);
    runs.values.group.push_back(known->second);
    std::optional<double> order;
    if (const double position = rows.getColumn(1).getDouble(); position >= 0) order = position;
    bool is_date = false;
    if (!context.trend_by.empty()) order = ParseOrderValue(sqlite::Text(rows, 5), is_date);
    runs.dates = runs.dates || is_date;
    runs.values.order.push_back(order.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return runs;
}

/// A unit after a number; empty for a dimensionless one.
std::string Spaced(const std::string& unit) { return unit == "1" ? "" : " " + unit; }

/// "20 runs scatter 1.03 times as much as their errors predict (p 0.2)".
std::string VerdictText(const Repeatability& all, const std::string& unit, std::size_t outliers) {
  std::string text = std::to_string(all.runs) + " runs scatter " + NumberText(all.ScatterRatio(), 3) +
                     " times as much as their errors predict (p " +
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

Json GroupName(const QuantityRuns& runs, const Context& context, std::size_t group) {
  return context.groups.name.empty() ? Json(nullptr) : Json(runs.groups[group]);
}

Json RepeatabilityJson(const QuantityRuns& runs, const Context& context, const Repeatability& all,
                       const std::string& unit, std::size_t outliers) {
  constexpr std::array<const char*, 3> kVerdicts = {"agrees", "scatter_larger", "scatter_smaller"};
  Json rows = Json::array();
  for (const GroupRepeatability& group : all.groups) {
    rows.push_back({{"group", context.groups.name.empty() ? "all runs" : runs.groups[group.group]},
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

Json OutliersJson(const QuantityRuns& runs, const Context& context, const std::vector<Outlier>& outliers) {
  Json list = Json::array();
  for (const Outlier& outlier : outliers) {
    if (list.size() == kMaxOutliers) break;
    list.push_back({{"id", runs.ids[outlier.run]},
                    {"group", GroupName(runs, context, runs.values.group[outlier.run])},
                    {"estimate", runs.values.estimate[outlier.run]},
                    {"std_error", NumberOrNull(runs.values.std_error[outlier.run])},
                    {"z", outlier.z}});
  }
  return list;
}

/// Every n-th point, so that at most kMaxPoints remain.
Json PointsJson(const QuantityRuns& runs, const Context& context) {
  Json points = Json::array();
  const std::size_t step = (runs.values.size() + kMaxPoints - 1) / kMaxPoints;
  for (std::size_t i = 0; i < runs.values.size(); i += step) {
    if (!std::isfinite(runs.values.order[i])) continue;
    points.push_back({{"x", runs.values.order[i]},
                      {"y", runs.values.estimate[i]},
                      {"std_error", NumberOrNull(runs.values.std_error[i])},
                      {"id", runs.ids[i]},
                      {"group", GroupName(runs, context, runs.values.group[i])}});
  }
  return points;
}

std::string TrendText(const Trend& trend, const std::string& unit, const std::string& per) {
  constexpr double kLevel = 0.01;
  const ValueAndError text = PdgText(trend.slope, trend.std_error);
  const std::string slope = text.value + " ± " + text.error + Spaced(unit) + " " + per;
  return (trend.p < kLevel ? "it changes by " : "no trend: ") + slope + " (p " + ProbabilityText(trend.p) + ")";
}

Json TrendJson(const QuantityRuns& runs, const Context& context, const std::string& unit,
               const std::vector<Outlier>& outliers) {
  const auto trend = FitTrend(runs.values, outliers);
  if (!trend) return nullptr;
  const std::string column = context.trend_by.empty() ? "position" : context.trend_by;
  const std::string per = runs.dates ? "per day" : context.trend_by.empty() ? "per run" : "per unit of " + column;
  return {{"column", column},
          {"unit", runs.dates ? Json("days since 1970-01-01") : Json(nullptr)},
          {"slope", trend->slope},
          {"std_error", trend->std_error},
          {"p", trend->p},
          {"text", TrendText(*trend, unit, per)},
          {"points", PointsJson(runs, context)},
          {"points_total", runs.values.size()}};
}

/// The median of those that are finite; null if there is none.
Json MedianOrNull(const std::vector<double>& values) {
  std::vector<double> known;
  std::ranges::copy_if(values, std::back_inserter(known), [](double value) { return std::isfinite(value); });
  return known.empty() ? Json(nullptr) : Json(MedianOf(std::move(known)));
}

Json DistributionJson(const Quantity& quantity, const QuantityRuns& runs) {
  const RunValues& values = runs.values;
  const Distribution distribution = Describe(values.estimate);
  return {{"model", quantity.model},
          {"name", quantity.name},
          {"unit", quantity.unit},
          {"derived", quantity.derived},
          {"runs", values.size()},
          {"median", distribution.median},
          {"mean", distribution.mean},
          {"std_dev", distribution.std_dev},
          {"minimum", distribution.minimum},
          {"maximum", distribution.maximum},
          {"lower_quartile", distribution.lower_quartile},
          {"upper_quartile", distribution.upper_quartile},
          {"median_std_error", MedianOrNull(runs.std_errors)},
          {"median_repeat_error", MedianOrNull(values.std_error)},
          {"histogram",
           {{"from", distribution.from},
            {"to", distribution.to},
            {"counts", distribution.counts},
            {"below", distribution.below},
            {"above", distribution.above}}}};
}

/// Outliers of this quantity, and runs that disagree in all parameters together.
std::vector<Outlier> LeftOut(const QuantityRuns& runs, const Context& context, const std::vector<Outlier>& outliers) {
  std::vector<Outlier> all = outliers;
  for (std::size_t i = 0; i < runs.ids.size() && !context.outliers.empty(); ++i) {
    if (context.outliers.contains(runs.ids[i]) && std::ranges::find(outliers, i, &Outlier::run) == outliers.end()) {
      all.push_back({i, 0});
    }
  }
  return all;
}

/// Why the runs of a quantity of the rig are not compared.
const char* NotComparedReason(const RunGroups& groups) {
  if (groups.compares()) return "no group has two runs with an error";
  return groups.unlike.empty() ? "no pendulum has two recordings"
                               : "the recordings differ too much to be repeats of one pendulum";
}

Json QuantityJson(SQLite::Database& database, const Quantity& quantity, const Context& context) {
  const QuantityRuns runs = RunsOf(database, quantity, context);
  if (runs.values.size() == 0) return nullptr;
  const bool of_the_rig = IsOfTheRig(quantity.name);
  const std::vector<Outlier> outliers = of_the_rig ? FindOutliers(runs.values) : std::vector<Outlier>();
  const std::vector<Outlier> left_out = of_the_rig ? LeftOut(runs, context, outliers) : std::vector<Outlier>();
  const auto repeatability = of_the_rig ? AnalyzeRepeatability(runs.values, left_out) : std::nullopt;
  Json json = DistributionJson(quantity, runs);
  json["repeatability"] =
      repeatability ? RepeatabilityJson(runs, context, *repeatability, quantity.unit, left_out.size()) : Json(nullptr);
  const char* reason = of_the_rig ? NotComparedReason(context.groups)
                                  : "it depends on how each run begins, so it is not a constant of the rig";
  json["repeatability_reason"] = repeatability ? Json(nullptr) : Json(reason);
  json["outliers"] = OutliersJson(runs, context, outliers);
  json["outliers_total"] = outliers.size();
  json["trend"] = TrendJson(runs, context, quantity.unit, left_out);
  return json;
}

/// The quantities of all models, or the parameters of one model.
Json QuantitiesJson(SQLite::Database& database, const Context& context, const std::string& only) {
  SQLite::Statement rows(database, R"sql(
SELECT model, name, unit, min(derived) FROM quantities WHERE ?1 = '' OR (model = ?1 AND derived = 0)
  GROUP BY model, name, unit ORDER BY model, min(derived), name, unit)sql");
  sqlite::Bind(rows, only);
  Json list = Json::array();
  while (rows.executeStep()) {
    Json json = QuantityJson(
        database,
        {sqlite::Text(rows, 0), sqlite::Text(rows, 1), sqlite::Text(rows, 2), rows.getColumn(3).getInt() == 1},
        context);
    if (!json.is_null()) list.push_back(std::move(json));
  }
  return list;
}

Json GroupingJson(const RunGroups& groups) {
  constexpr std::array<const char*, 5> kBy = {"column", "true_values", "rig", "folder", "all"};
  return {{"by", kBy.at(static_cast<std::size_t>(groups.by))},
          {"name", TextOrNull(groups.name)},
          {"is_stated", groups.is_stated},
          {"pendulums", groups.groups},
          {"smallest", groups.smallest},
          {"largest", groups.largest},
          {"unlike", groups.unlike.size()},
          {"is_compared", groups.compares()},
          {"text", GroupsText(groups)},
          {"otherwise", TextOrNull(OtherGroupsText(groups))}};
}

Json VerdictsJson(const Json& overview, const Json& parameters, const RunGroups& groups, bool left_out,
                  const std::string& only) {
  Json list = Json::array();
  for (const Json& row : overview["models"]) {
    const auto model = row["model"].get<std::string>();
    if (only.empty() || only == model) list.push_back(VerdictJson(model, parameters, groups, left_out));
  }
  return list;
}

Result<void> CheckColumn(const char* flag, const std::string& column, const std::vector<std::string>& known) {
  if (column.empty() || ColumnSql(column).starts_with("runs.")) return {};
  if (std::ranges::find(known, column) != known.end()) return {};
  return Error(StatusCode::kInvalidArgument, std::string(flag) + ": the manifest has no column '" + column + "'" +
                                                 (known.empty() ? ", nor any other" : "; it has " + NameList(known)));
}

Result<void> CheckGroupBy(const std::string& group_by, const std::vector<std::string>& known) {
  return IsWayToGroup(group_by) ? Result<void>() : CheckColumn("--group_by", group_by, known);
}

/// Number of runs whose value in the column is neither a number nor a date, and one such value.
std::pair<std::int64_t, std::string> WithoutOrder(SQLite::Database& database, const std::string& column) {
  std::pair<std::int64_t, std::string> found;
  if (column.empty()) return found;
  SQLite::Statement rows(database, "SELECT " + ColumnSql(column) + " FROM runs WHERE " + kIsLive);
  while (rows.executeStep()) {
    bool is_date = false;
    const std::string value = sqlite::Text(rows, 0);
    if (ParseOrderValue(value, is_date)) continue;
    if (found.first++ == 0) found.second = value;
  }
  return found;
}

Json WarningsJson(SQLite::Database& database, const StoreCounts& counts, const Json& store, const RunCounts& runs,
                  const SummaryOptions& options) {
  Json warnings = Json::array();
  const auto add = [&](const char* code, const std::string& message) {
    warnings.push_back({{"code", code}, {"message", message}});
  };
  if (!runs.is_complete) {
    add("incomplete",
        "the last refit has not reached all recordings, so some results may be of their former content; give its "
        "command "
        "again, unless it is still running");
  }
  if (counts.pending > 0) add("pending", std::to_string(counts.pending) + " runs are not refitted yet");
  if (counts.stale > 0) {
    add("stale", std::to_string(counts.stale) +
                     " runs keep a former result (the column stale says why); statistics leave them out");
  }
  if (counts.earlier > 0) {
    add("not_in_the_manifest", std::to_string(counts.earlier) +
                                   " runs are not among the recordings of the last refit; statistics leave them out");
  }
  if (counts.former_fits > 0) {
    add("former_models", std::to_string(counts.former_fits) +
                             " fits are of models that the last refit did not ask for; statistics leave them out");
  }
  const std::int64_t same =
      database.execAndGet("SELECT count(data_sha256) - count(DISTINCT data_sha256) FROM runs WHERE " + kIsFitted)
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

Result<void> CheckGroupBy(Store& store, const std::string& group_by) {
  return sqlite::Guard(store.name(), [&]() -> Result<void> {
    return CheckGroupBy(group_by, sqlite::Texts(store.database(), sqlite::kManifestColumns));
  });
}

Result<Json> Summarize(Store& store, const SummaryOptions& options) {
  ASSIGN_OR_RETURN(const auto meta, store.Meta());
  ASSIGN_OR_RETURN(const auto counts, store.Count());
  if (counts.fits == 0) {
    return Error(StatusCode::kFailedPrecondition, store.name() + ": no run has a fit; refit some first");
  }
  return sqlite::Guard(store.name(), [&]() -> Result<Json> {
    SQLite::Database& database = store.database();
    const std::vector<std::string> columns = sqlite::Texts(database, sqlite::kManifestColumns);
    RETURN_IF_ERROR(CheckGroupBy(options.group_by, columns));
    RETURN_IF_ERROR(CheckColumn("--trend_by", options.trend_by, columns));
    ASSIGN_OR_RETURN(auto overview, Overview(store));
    RunGroups groups = GroupRuns(database, options.group_by);
    const std::string main = MainModel(database, overview, groups), only = options.main_model_only ? main : "";
    FindUnlikeGroups(database, main, groups);
    RunAgreement agreement;
    if (!options.without_agreement) agreement = TestRunAgreement(database, main, groups);
    const RunCounts runs = CountRuns(database);
    const Json parameters = QuantitiesJson(database, {groups, agreement.outliers, options.trend_by}, only);
    Json json = {{"schema_version", kSchemaVersion},
                 {"tool", {{"name", "refit_pendulums"}, {"version", kVersion}}},
                 {"headline", CountsJson(runs)},
                 {"grouping", GroupingJson(groups)},
                 {"main_model", TextOrNull(main)},
                 {"verdicts", VerdictsJson(overview, parameters, groups, !agreement.outliers.empty(), only)},
                 {"agreement", std::move(agreement.json)},
                 {"store", StoreJson(store, meta, counts)},
                 {"group_by", TextOrNull(groups.name)},
                 {"trend_by", TextOrNull(options.trend_by)}};
    json.update(overview);
    json["parameters"] = parameters;
    json["warnings"] = WarningsJson(database, counts, json["store"], runs, options);
    return json;
  });
}

}  // namespace pendulum
