// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/summary_json.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/base/version.h"
#include "pendulum/batch/quantity_text.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 2;

Json GroupJson(const std::optional<std::string>& group) { return group ? Json(*group) : Json(nullptr); }

Json ExamplesJson(const std::vector<RunCounts::Run>& runs) {
  return ArrayOf(runs, [](const auto& run) { return Json{{"id", run.id}, {"reason", run.reason}}; });
}

Json HeadlineJson(const RunCounts& counts) {
  return {{"text", counts.text},
          {"runs", counts.runs},
          {"fitted", counts.fitted},
          {"not_converged", counts.not_converged},
          {"missing", counts.missing},
          {"refused", counts.refused},
          {"pending", counts.pending},
          {"stale", counts.stale},
          {"unlisted", counts.unlisted},
          {"missing_runs", ExamplesJson(counts.missing_runs)},
          {"refused_runs", ExamplesJson(counts.refused_runs)},
          {"stale_runs", ExamplesJson(counts.stale_runs)}};
}

Json GroupingJson(const Grouping& grouping) {
  return {{"by", grouping.by},
          {"name", TextOrNull(grouping.name)},
          {"is_stated", grouping.is_stated},
          {"pendulums", grouping.pendulums},
          {"smallest", grouping.smallest},
          {"largest", grouping.largest},
          {"unlike", grouping.unlike},
          {"is_compared", grouping.is_compared},
          {"text", grouping.text},
          {"otherwise", TextOrNull(grouping.otherwise)}};
}

Json VerdictJson(const ErrorVerdict& verdict) {
  return {{"model", verdict.law}, {"verdict", verdict.verdict}, {"level", verdict.level}, {"text", verdict.text}};
}

Json NewsJson(const RefitNews& news) {
  return {{"began", TextOrNull(news.began)},
          {"ended", TextOrNull(news.ended)},
          {"new", news.fresh},
          {"again", news.again},
          {"text", TextOrNull(news.text)}};
}

Json RunJson(const ListedRun& run) {
  return {{"id", run.id},
          {"level", run.level},
          {"state", run.state},
          {"text", TextOrNull(run.text)},
          {"model", TextOrNull(run.law)},
          {"fitted", TextOrNull(run.fitted)},
          {"news", TextOrNull(run.news)},
          {"command", TextOrNull(run.command)}};
}

Json AgreementJson(const RunAgreement& agreement) {
  if (agreement.groups == 0) return nullptr;
  const auto run_json = [](const DisagreeingRun& run) {
    return Json{{"id", run.id},
                {"parameter", run.parameter},
                {"estimate", run.estimate},
                {"others", run.others},
                {"z", NumberOrNull(run.z)}};
  };
  const auto row_json = [&](const GroupAgreement& row) {
    return Json{{"group", GroupJson(row.group)},
                {"runs", row.runs},
                {"statistic", row.statistic},
                {"dof", row.dof},
                {"p", row.p},
                {"outliers", ArrayOf(row.outliers, run_json)}};
  };
  return {{"model", agreement.law},
          {"groups", agreement.groups},
          {"disagreeing", agreement.disagreeing},
          {"rows", ArrayOf(agreement.rows, row_json)}};
}

Json StoreJson(const StoreFacts& store) {
  return {{"path", store.path},
          {"runs", store.runs},
          {"refitted", store.runs - store.pending},
          {"pending", store.pending},
          {"fits", store.fits},
          {"versions", store.versions},
          {"cpus", store.cpus},
          {"manifest_sha256", TextOrNull(store.manifest_sha256)}};
}

Json LawJson(const LawCounts& counts) {
  return {{"model", counts.law},
          {"fits", counts.fits},
          {"converged", counts.converged},
          {"not_converged", counts.not_converged},
          {"not_identifiable", counts.not_identifiable},
          {"failed", counts.failed}};
}

Json RecommendationJson(const RecommendationCount& count) {
  return {{"model", TextOrNull(count.law)}, {"runs", count.runs}};
}

Json FailureJson(const FailureCount& failure) {
  return {{"status", failure.status}, {"exit_code", failure.exit_code}, {"reason", failure.reason},
          {"fits", failure.fits},     {"models", failure.laws},         {"examples", failure.examples}};
}

/// The numbers of a distribution as texts, under the same keys.
Json DistributionTexts(const QuantitySummary& quantity) {
  const Distribution& distribution = quantity.distribution;
  const auto text = [&](double value) { return ValueText(distribution, value); };
  return {{"median", text(distribution.median)},
          {"mean", text(distribution.mean)},
          {"std_dev", quantity.runs == 1 ? "-" : SpreadText(distribution.std_dev)},
          {"minimum", text(distribution.minimum)},
          {"maximum", text(distribution.maximum)},
          {"lower_quartile", text(distribution.lower_quartile)},
          {"upper_quartile", text(distribution.upper_quartile)},
          {"median_std_error", SpreadText(quantity.median_std_error)},
          {"median_repeat_error", SpreadText(quantity.median_repeat_error)}};
}

Json DistributionJson(const QuantitySummary& quantity) {
  const Distribution& distribution = quantity.distribution;
  return {{"model", quantity.law},
          {"name", quantity.name},
          {"unit", quantity.unit},
          {"derived", quantity.is_derived},
          {"runs", quantity.runs},
          {"median", distribution.median},
          {"mean", distribution.mean},
          {"std_dev", quantity.runs == 1 ? Json(nullptr) : Json(distribution.std_dev)},
          {"minimum", distribution.minimum},
          {"maximum", distribution.maximum},
          {"lower_quartile", distribution.lower_quartile},
          {"upper_quartile", distribution.upper_quartile},
          {"median_std_error", NumberOrNull(quantity.median_std_error)},
          {"median_repeat_error", NumberOrNull(quantity.median_repeat_error)},
          {"texts", DistributionTexts(quantity)},
          {"histogram",
           {{"from", distribution.from},
            {"to", distribution.to},
            {"counts", distribution.counts},
            {"below", distribution.below},
            {"above", distribution.above}}}};
}

Json RepeatabilityJson(const QuantitySummary& quantity) {
  if (!quantity.repeatability) return nullptr;
  constexpr int kChi2Digits = 5;
  constexpr std::array<const char*, 3> kVerdicts = {"agrees", "scatter_larger", "scatter_smaller"};
  const Repeatability& all = *quantity.repeatability;
  Json rows = Json::array();
  for (std::size_t i = 0; i < all.groups.size(); ++i) {
    const GroupRepeatability& group = all.groups[i];
    const auto [from, to] = group.MeanInterval();
    const auto [least, most] = group.ScatterInterval();
    rows.push_back({{"group", quantity.repeated_groups[i]},
                    {"runs", group.runs},
                    {"weighted_mean", group.mean},
                    {"std_error", group.std_error},
                    {"interval95", IntervalJson(from, to)},
                    {"scatter_ratio", group.ScatterRatio()},
                    {"scatter_interval95", IntervalJson(least, most)},
                    {"p", group.P()},
                    {"disagrees", all.Disagrees(group)},
                    {"texts",
                     {{"weighted_mean", PlusMinusText(group.mean, group.std_error)},
                      {"scatter_ratio", RatioText(group.ScatterRatio())},
                      {"scatter_interval95", RatioText(least) + " to " + RatioText(most)},
                      {"p", ProbabilityText(group.P())}}}});
  }
  const double p = std::min(all.lower_p, all.upper_p);
  return {{"groups", all.groups.size()},
          {"runs", all.runs},
          {"dof", all.dof},
          {"chi2", all.chi2},
          {"scatter_ratio", all.ScatterRatio()},
          {"p", p},
          {"between_std_dev", all.between},
          {"verdict", kVerdicts.at(static_cast<std::size_t>(all.verdict))},
          {"has_enough_runs", all.HasEnoughRuns()},
          {"text", quantity.repeatability_text},
          {"texts",
           {{"chi2", NumberText(all.chi2, kChi2Digits)},
            {"scatter_ratio", RatioText(all.ScatterRatio())},
            {"p", ProbabilityText(p)},
            {"between_std_dev", SpreadText(all.between)}}},
          {"rows", std::move(rows)}};
}

Json OutlierJson(const OutlyingRun& run) {
  return {{"id", run.id},
          {"group", GroupJson(run.group)},
          {"estimate", run.estimate},
          {"std_error", NumberOrNull(run.std_error)},
          {"text", PlusMinusText(run.estimate, run.std_error)},
          {"z", run.z},
          {"z_text", DistanceText(run.z)}};
}

Json TrendJson(const QuantitySummary& quantity) {
  if (!quantity.trend) return nullptr;
  const TrendSummary& trend = *quantity.trend;
  const auto point_json = [](const TrendSummary::Point& point) {
    return Json{{"x", point.x},
                {"y", point.y},
                {"std_error", NumberOrNull(point.std_error)},
                {"text", PlusMinusText(point.y, point.std_error)},
                {"id", point.id},
                {"group", GroupJson(point.group)}};
  };
  return {{"column", trend.column},
          {"unit", trend.is_of_dates ? Json("days since 1970-01-01") : Json(nullptr)},
          {"slope", trend.trend.slope},
          {"std_error", trend.trend.std_error},
          {"p", trend.trend.p},
          {"text", trend.text},
          {"is_moving", trend.is_moving},
          {"texts", {{"slope", trend.slope}, {"p", ProbabilityText(trend.trend.p)}}},
          {"points", ArrayOf(trend.points, point_json)},
          {"points_total", quantity.runs}};
}

Json QuantityJson(const QuantitySummary& quantity) {
  Json json = DistributionJson(quantity);
  json["repeatability"] = RepeatabilityJson(quantity);
  json["repeatability_reason"] = quantity.repeatability ? Json(nullptr) : Json(quantity.repeatability_text);
  json["outliers"] = ArrayOf(quantity.outliers, OutlierJson);
  json["outliers_total"] = quantity.outliers_total;
  json["trend"] = TrendJson(quantity);
  return json;
}

Json WarningJson(const Warning& warning) { return {{"code", warning.code.text()}, {"message", MessageText(warning)}}; }

}  // namespace

nlohmann::ordered_json ToJson(const StoreSummary& summary) {
  return {{"schema_version", kSchemaVersion},
          {"tool", {{"name", "refit_pendulums"}, {"version", kVersion}}},
          {"headline", HeadlineJson(summary.headline)},
          {"grouping", GroupingJson(summary.grouping)},
          {"main_model", TextOrNull(summary.main_law)},
          {"verdicts", ArrayOf(summary.verdicts, VerdictJson)},
          {"agreement", AgreementJson(summary.agreement)},
          {"disagreement", TextOrNull(summary.disagreement)},
          {"refit", NewsJson(summary.news)},
          {"runs", ArrayOf(summary.runs, RunJson)},
          {"store", StoreJson(summary.store)},
          {"group_by", TextOrNull(summary.grouping.name)},
          {"trend_by", TextOrNull(summary.trend_by)},
          {"models", ArrayOf(summary.overview.laws, LawJson)},
          {"recommendations", ArrayOf(summary.overview.recommendations, RecommendationJson)},
          {"failures", ArrayOf(summary.overview.failures, FailureJson)},
          {"parameters", ArrayOf(summary.quantities, QuantityJson)},
          {"warnings", ArrayOf(summary.warnings, WarningJson)}};
}

}  // namespace pendulum
