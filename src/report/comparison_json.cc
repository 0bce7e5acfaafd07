// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/comparison_json.h"

#include <string>
#include <string_view>

#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

std::string_view LikelihoodName(Likelihood likelihood) {
  switch (likelihood) {
    case Likelihood::kIndependent: return "independent";
    case Likelihood::kCorrelated: return "correlated";
    case Likelihood::kScaled: return "scaled";
    case Likelihood::kNone: return "none";
  }
  return "none";
}

/// null without a prediction; the row then gives the reason.
Json PredictionJson(const std::string& what, const Prediction& prediction, const std::string& unit, NumberObject& row) {
  if (prediction.samples == 0) {
    row.AddReason(what + ": " + (prediction.reason.empty() ? "not made" : prediction.reason));
    return nullptr;
  }
  return NumberObject()
      .Set(KeyWithUnit("rms", unit), prediction.rms)
      .Set("standardized", prediction.standardized)
      .Set("samples", Json(prediction.samples))
      .Done();
}

Json RowJson(const ComparisonRow& row, const std::string& unit) {
  NumberObject object;
  if (!row.judged) object.AddReason(row.reason.empty() ? "not compared" : row.reason);
  object.Set("model", Json(row.model))
      .Set("is_compared", Json(row.judged))
      .Set("parameters", Json(row.parameters))
      .Set(KeyWithUnit("rms_residual", unit), row.rms)
      .Set("log_likelihood", NumberOrNull(row.log_likelihood))
      .Set("aic", NumberOrNull(row.aic))
      .Set("aicc", NumberOrNull(row.aicc))
      .Set("bic", NumberOrNull(row.bic))
      .Set("delta_bic", NumberOrNull(row.delta_bic))
      .Set("akaike_weight", NumberOrNull(row.akaike_weight));
  object.Set("cross_validation", PredictionJson("cross-validation", row.cross_validation, unit, object));
  object.Set("forward_prediction", PredictionJson("forward prediction", row.forward, unit, object));
  return object.Set("lag1_correlation", row.lag1_correlation)
      .Set("ljung_box_p", row.ljung_box_p)
      .Set("lack_of_fit", Json(row.lack_of_fit))
      .Done();
}

Json TestJson(const NestedTest& test) {
  return NumberObject()
      .Set("simpler", Json(test.simpler))
      .Set("richer", Json(test.richer))
      .Set("added", Json(test.added))
      .Set("statistic", test.statistic)
      .Set("null", TextOrNull(test.null))
      .Set("p", test.p, test.reason.empty() ? "there is no p" : test.reason)
      .Done();
}

Json HalfJson(const HalvesRow& row) {
  return NumberObject()
      .Set("parameter", Json(row.name))
      .Set("unit", Json(row.unit))
      .Set("first", row.first)
      .Set("first_std_error", row.first_std_error)
      .Set("second", row.second)
      .Set("second_std_error", row.second_std_error)
      .Set("z", row.z)
      .Done();
}

Json HalvesJson(const Constancy& constancy) {
  const std::string missing = constancy.reason.empty() ? "the halves were not compared" : constancy.reason;
  return NumberObject()
      .Set("statistic", constancy.halves_statistic)
      .Set("dof", Json(constancy.halves_dof))
      .Set("p", constancy.halves_p, missing)
      .Set("rows", ArrayOf(constancy.halves, HalfJson))
      .Done();
}

/// If the friction is fixed, its numbers are null and no reason is given.
Json WindowJson(const AmplitudeRow& row) {
  return NumberObject()
      .Set("from_s", row.from)
      .Set("to_s", row.to)
      .Set("amplitude_rad", row.amplitude)
      .Set("inertia", NumberOrNull(row.inertia))
      .Set("inertia_std_error", NumberOrNull(row.inertia_std_error))
      .Set("friction", NumberOrNull(row.friction))
      .Set("friction_std_error", NumberOrNull(row.friction_std_error))
      .Done();
}

Json TrendJson(const AmplitudeTrend& trend) {
  return NumberObject()
      .Set("parameter", Json(trend.name))
      .Set("unit", Json(trend.unit))
      .Set("slope", trend.slope)
      .Set("slope_std_error", trend.slope_std_error)
      .Set("span", trend.span)
      .Set("p", trend.p)
      .Done();
}

bool IsTested(const Constancy& constancy) { return constancy.halves_p || !constancy.trends.empty(); }

}  // namespace

nlohmann::ordered_json ComparisonJson(const Identification& identification) {
  if (!identification.comparison) return nullptr;
  const Comparison& comparison = *identification.comparison;
  const bool has_criterion = comparison.likelihood != Likelihood::kNone;
  const std::string& unit = identification.unit;
  return NumberObject()
      .Set("recommended", TextOrNull(comparison.recommended))
      .Set("reason", Json(comparison.reason))
      .Set("criterion", has_criterion ? Json("bic") : Json(nullptr))
      .Set("criterion_reason", Json(comparison.criterion))
      .Set("likelihood", Json(LikelihoodName(comparison.likelihood)))
      .Set("effective_samples", NumberOrNull(comparison.effective_samples))
      .Set("rows", ArrayOf(comparison.rows, [&](const ComparisonRow& row) { return RowJson(row, unit); }))
      .Set("tests", ArrayOf(comparison.tests, TestJson))
      .Done();
}

nlohmann::ordered_json ConstancyJson(const Constancy* constancy) {
  if (constancy == nullptr || !IsTested(*constancy)) return nullptr;
  NumberObject json;
  json.Set("verdict", Json(constancy->verdict))
      .Set("constant", Json(constancy->constant()))
      .Set("halves", HalvesJson(*constancy))
      .Set("amplitude", Json{{"windows", ArrayOf(constancy->windows, WindowJson)},
                             {"trends", ArrayOf(constancy->trends, TrendJson)}});
  if (!constancy->reason.empty()) json.AddReason(constancy->reason);
  return json.Done();
}

std::string NoConstancyReason(const FitReport& fit, const Constancy* constancy) {
  if (constancy != nullptr && IsTested(*constancy)) return "";
  if (constancy != nullptr && !constancy->reason.empty()) return constancy->reason;
  if (fit.termination != Termination::kConverged) return "the fit is " + std::string(TerminationName(fit.termination));
  return "it was not tested";
}

}  // namespace pendulum
