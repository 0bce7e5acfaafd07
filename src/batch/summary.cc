// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "batch/disagreement_text.h"
#include "batch/run_agreement.h"
#include "batch/run_groups.h"
#include "batch/run_kinds.h"
#include "batch/run_list.h"
#include "batch/sqlite.h"
#include "batch/summary_verdict.h"
#include "pendulum/analysis/separate_estimates.h"
#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/overview.h"
#include "pendulum/batch/run_statistics.h"

namespace pendulum {
namespace {

constexpr std::size_t kMaxOutliers = 50;
constexpr std::size_t kMaxPoints = 2000;

StoreFacts FactsOf(Store& store, const StoreMeta& meta, const StoreCounts& counts) {
  const auto distinct = [&](const std::string& column) {
    return sqlite::Texts(store.database(), "SELECT DISTINCT " + column + " FROM runs WHERE " + column +
                                               " IS NOT NULL ORDER BY " + column);
  };
  return {store.name(), meta.manifest_sha256, counts.runs,    counts.pending,
          counts.fits,  distinct("version"),  distinct("cpu")};
}

/// One parameter or derived quantity of one model, in one unit.
struct Quantity {
  std::string law, name, unit;
  bool is_derived = false;
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
  sqlite::Bind(rows, quantity.law, quantity.name, quantity.unit);
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

std::optional<std::string> GroupName(const QuantityRuns& runs, const Context& context, std::size_t group) {
  return context.groups.name.empty() ? std::nullopt : std::optional(runs.groups[group]);
}

std::vector<OutlyingRun> Named(const std::vector<Outlier>& outliers, const QuantityRuns& runs, const Context& context) {
  std::vector<OutlyingRun> named;
  for (const auto& [run, z] : outliers) {
    if (named.size() == kMaxOutliers) break;
    named.push_back({runs.ids[run], GroupName(runs, context, runs.values.group[run]), runs.values.estimate[run],
                     runs.values.std_error[run], z});
  }
  return named;
}

/// Every n-th point, so that at most kMaxPoints remain.
std::vector<TrendSummary::Point> PointsOf(const QuantityRuns& runs, const Context& context) {
  std::vector<TrendSummary::Point> points;
  const std::size_t step = (runs.values.size() + kMaxPoints - 1) / kMaxPoints;
  for (std::size_t i = 0; i < runs.values.size(); i += step) {
    if (!std::isfinite(runs.values.order[i])) continue;
    points.push_back({runs.values.order[i], runs.values.estimate[i], runs.values.std_error[i], runs.ids[i],
                      GroupName(runs, context, runs.values.group[i])});
  }
  return points;
}

std::string TrendText(const Trend& trend, bool is_moving, const std::string& slope) {
  return (is_moving ? "it changes by " : "no trend: ") + slope + " (p " + ProbabilityText(trend.p) + ")";
}

std::optional<TrendSummary> TrendOf(const QuantityRuns& runs, const Context& context, const std::string& unit,
                                    const std::vector<Outlier>& outliers) {
  const auto trend = FitTrend(runs.values, outliers);
  if (!trend) return std::nullopt;
  const std::string column = context.trend_by.empty() ? "position" : context.trend_by;
  const std::string per = runs.dates ? "per day" : context.trend_by.empty() ? "per run" : "per unit of " + column;
  const std::string slope = PlusMinusText(trend->slope, trend->std_error) + Spaced(unit) + " " + per;
  constexpr double kLevel = 0.01;
  const bool is_moving = trend->p < kLevel;
  return TrendSummary{
      *trend, column, runs.dates, is_moving, slope, TrendText(*trend, is_moving, slope), PointsOf(runs, context)};
}

/// The median of those that are finite.
std::optional<double> MedianOfFinite(const std::vector<double>& values) {
  std::vector<double> known;
  std::ranges::copy_if(values, std::back_inserter(known), [](double value) { return std::isfinite(value); });
  return known.empty() ? std::nullopt : std::optional(MedianOf(std::move(known)));
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

/// std::nullopt if no run has a value.
std::optional<QuantitySummary> SummaryOf(SQLite::Database& database, const Quantity& quantity, const Context& context) {
  const QuantityRuns runs = RunsOf(database, quantity, context);
  if (runs.values.size() == 0) return std::nullopt;
  const bool of_the_rig = IsOfTheRig(quantity.name);
  const std::vector<Outlier> outliers = of_the_rig ? FindOutliers(runs.values) : std::vector<Outlier>();
  const std::vector<Outlier> left_out = of_the_rig ? LeftOut(runs, context, outliers) : std::vector<Outlier>();
  QuantitySummary summary{.law = quantity.law,
                          .name = quantity.name,
                          .unit = quantity.unit,
                          .is_derived = quantity.is_derived,
                          .runs = runs.values.size(),
                          .distribution = Describe(runs.values.estimate),
                          .median_std_error = MedianOfFinite(runs.std_errors),
                          .median_repeat_error = MedianOfFinite(runs.values.std_error),
                          .outliers = Named(outliers, runs, context),
                          .outliers_total = outliers.size(),
                          .trend = TrendOf(runs, context, quantity.unit, left_out)};
  if (of_the_rig) summary.repeatability = AnalyzeRepeatability(runs.values, left_out);
  if (!summary.repeatability) {
    summary.repeatability_text = of_the_rig ? NotComparedReason(context.groups)
                                            : "it depends on how each run begins, so it is not a constant of the rig";
    return summary;
  }
  summary.repeatability_text = VerdictText(*summary.repeatability, quantity.unit, left_out.size());
  for (const GroupRepeatability& group : summary.repeatability->groups) {
    summary.repeated_groups.push_back(GroupName(runs, context, group.group).value_or("all runs"));
  }
  return summary;
}

/// The quantities of all models, or the parameters of one model.
std::vector<QuantitySummary> SummarizeQuantities(SQLite::Database& database, const Context& context,
                                                 const std::string& only) {
  SQLite::Statement rows(database, R"sql(
SELECT model, name, unit, min(derived) FROM quantities WHERE ?1 = '' OR (model = ?1 AND derived = 0)
  GROUP BY model, name, unit ORDER BY model, min(derived), name, unit)sql");
  sqlite::Bind(rows, only);
  std::vector<QuantitySummary> quantities;
  while (rows.executeStep()) {
    auto summary = SummaryOf(
        database,
        {sqlite::Text(rows, 0), sqlite::Text(rows, 1), sqlite::Text(rows, 2), rows.getColumn(3).getInt() == 1},
        context);
    if (summary) quantities.push_back(*std::move(summary));
  }
  return quantities;
}

/// Gives the runs that disagree the z of the table of outliers, so that a run has one figure.
void SetDistances(SQLite::Database& database, const Context& context, const std::vector<QuantitySummary>& quantities,
                  RunAgreement& agreement) {
  for (const QuantitySummary& quantity : quantities) {
    if (quantity.law != agreement.law) continue;
    std::vector<DisagreeingRun*> named;
    for (GroupAgreement& row : agreement.rows) {
      for (DisagreeingRun& run : row.outliers) {
        if (run.parameter == quantity.name) named.push_back(&run);
      }
    }
    if (named.empty()) continue;
    const QuantityRuns runs =
        RunsOf(database, {quantity.law, quantity.name, quantity.unit, quantity.is_derived}, context);
    const std::vector<double> z = DistancesFromGroup(runs.values);
    for (DisagreeingRun* const run : named) {
      const auto found = std::ranges::find(runs.ids, run->id);
      if (found != runs.ids.end()) run->z = z[static_cast<std::size_t>(found - runs.ids.begin())];
    }
  }
}

Grouping GroupingOf(const RunGroups& groups) {
  constexpr std::array<const char*, 5> kBy = {"column", "true_values", "rig", "folder", "all"};
  return {.by = kBy.at(static_cast<std::size_t>(groups.by)),
          .name = groups.name,
          .is_stated = groups.is_stated,
          .pendulums = groups.groups,
          .smallest = groups.smallest,
          .largest = groups.largest,
          .unlike = groups.unlike.size(),
          .is_compared = groups.compares(),
          .text = GroupsText(groups),
          .otherwise = OtherGroupsText(groups)};
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

std::vector<Warning> WarningsOf(SQLite::Database& database, const StoreCounts& counts, const StoreSummary& summary) {
  std::vector<Warning> warnings;
  const auto add = [&](WarningCode code, const std::string& finding, const std::string& explanation = "") {
    warnings.push_back({.code = code, .finding = finding, .explanation = explanation});
  };
  if (!summary.headline.is_complete) {
    warnings.push_back({.code = "incomplete",
                        .finding = "the last refit has not reached all recordings, so some results may be of their "
                                   "former content",
                        .advice = "give its command again, unless it is still running"});
  }
  if (counts.pending > 0) add("pending", std::to_string(counts.pending) + " runs are not refitted yet");
  constexpr const char* kLeftOut = "statistics leave them out";
  if (counts.stale > 0) {
    add("stale", std::to_string(counts.stale) + " runs keep a former result (the column stale says why)", kLeftOut);
  }
  if (counts.earlier > 0) {
    add("not_in_the_manifest", std::to_string(counts.earlier) + " runs are not among the recordings of the last refit",
        kLeftOut);
  }
  if (counts.former_fits > 0) {
    add("former_models", std::to_string(counts.former_fits) + " fits are of models that the last refit did not ask for",
        kLeftOut);
  }
  const std::int64_t same =
      database.execAndGet("SELECT count(data_sha256) - count(DISTINCT data_sha256) FROM runs WHERE " + kIsFitted)
          .getInt64();
  if (same > 0) {
    add("same_data", std::to_string(same) + " runs have the same data as another run",
        "unless their windows differ, one swing counts several times");
  }
  const auto [without, example] = WithoutOrder(database, summary.trend_by);
  if (without > 0) {
    add("no_order",
        "the column " + summary.trend_by + " of " + std::to_string(without) +
            " runs is neither a number nor a date such as 2026-03-01, for example " + Quoted(example),
        "trends leave these runs out");
  }
  if (summary.store.versions.size() > 1) add("mixed_versions", "the fits come from several versions of the program");
  if (summary.store.cpus.size() > 1) {
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

Result<StoreSummary> Summarize(Store& store, const SummaryOptions& options) {
  ASSIGN_OR_RETURN(const auto meta, store.Meta());
  ASSIGN_OR_RETURN(const auto counts, store.Count());
  if (counts.fits == 0) {
    return ErrorAt(StatusCode::kFailedPrecondition, store.name(), "no run has a fit; refit some first");
  }
  return sqlite::Guard(store.name(), [&]() -> Result<StoreSummary> {
    SQLite::Database& database = store.database();
    const std::vector<std::string> columns = sqlite::Texts(database, sqlite::kManifestColumns);
    RETURN_IF_ERROR(CheckGroupBy(options.group_by, columns));
    RETURN_IF_ERROR(CheckColumn("--trend_by", options.trend_by, columns));
    StoreSummary summary{.store = FactsOf(store, meta, counts), .trend_by = options.trend_by};
    ASSIGN_OR_RETURN(summary.overview, Overview(store));
    RunGroups groups = GroupRuns(database, options.group_by);
    summary.main_law = MainLaw(database, summary.overview, groups);
    FindUnlikeGroups(database, summary.main_law, groups);
    if (!options.without_agreement) summary.agreement = TestRunAgreement(database, summary.main_law, groups);
    summary.grouping = GroupingOf(groups);
    summary.headline = CountRuns(database, meta);
    const std::set<std::string>& outliers = summary.agreement.outliers;
    const std::string only = options.main_law_only ? summary.main_law : "";
    const Context context{groups, outliers, options.trend_by};
    summary.quantities = SummarizeQuantities(database, context, only);
    SetDistances(database, context, summary.quantities, summary.agreement);
    summary.disagreement = DisagreementText(summary);
    summary.news = NewsOf(database, meta);
    if (!options.without_runs) summary.runs = ListRuns(database, meta, DifferencesById(summary));
    for (const LawCounts& law : summary.overview.laws) {
      if (!only.empty() && only != law.law) continue;
      summary.verdicts.push_back(VerdictOf(law.law, summary.quantities, groups, !outliers.empty()));
    }
    summary.warnings = WarningsOf(database, counts, summary);
    return summary;
  });
}

}  // namespace pendulum
