// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_json.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/report/ambiguity_sections.h"
#include "pendulum/report/budget_sections.h"
#include "pendulum/report/closed_form_json.h"
#include "pendulum/report/comparison_json.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/estimate_texts.h"
#include "pendulum/report/homogeneity_json.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/result_summary.h"
#include "pendulum/report/suspicion_sections.h"

namespace pendulum {

using Json = nlohmann::ordered_json;

namespace {

/// The standard errors by source; only the sources that have one.
Json ErrorBudgetJson(const std::optional<double>& std_error, const SystematicErrors& systematic) {
  Json budget = Json::object();
  if (std_error) budget["noise"] = NumberOrNull(std_error);
  for (const ErrorSource source : kErrorSources) {
    if (systematic.Of(source) > 0) budget[std::string(ErrorSourceName(source))] = systematic.Of(source);
  }
  return budget;
}

/// The 95 % interval with all errors, of a ParameterEstimate or DerivedQuantity.
template <typename Estimated>
Json TotalIntervalJson(const Estimated& quantity) {
  const auto [lower, upper] = TotalInterval95(quantity);
  return IntervalJson(lower, upper);
}

Json ParameterJson(const ParameterEstimate& parameter) {
  NumberObject object;
  if (parameter.open_interval != OpenInterval::kClosed) {
    object.AddReason("the interval is open: " + std::string(Sentence(parameter.open_interval)));
  }
  if (parameter.unseen_friction) object.Set("unseen_friction_std_error", *parameter.unseen_friction);
  Json json = object.Set("estimate", parameter.estimate)
                  .Set("std_error", parameter.std_error, parameter.reason.empty() ? "not estimated" : parameter.reason)
                  .Set("interval95", IntervalJson(parameter.lower95, parameter.upper95))
                  .Set("systematic_std_error", NumberOrNull(parameter.systematic.Total()))
                  .Set("total_std_error", NumberOrNull(TotalStdError(parameter.std_error, parameter.systematic)))
                  .Set("total_interval95", TotalIntervalJson(parameter))
                  .Set("error_budget", ErrorBudgetJson(parameter.std_error, parameter.systematic))
                  .Set("unit", Json(parameter.unit))
                  .Set("fixed", Json(parameter.fixed))
                  .Set("at_bound", Json(parameter.at_bound))
                  .Done();
  AddTexts(json);
  return json;
}

template <typename Element>
Json MatrixJson(const std::vector<std::string>& names, const ShowsParameter& shows, const Element& element) {
  std::vector<Eigen::Index> shown;
  Json shown_names = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!shows(names[i])) continue;
    shown.push_back(static_cast<Eigen::Index>(i));
    shown_names.push_back(names[i]);
  }
  const auto row_of = [&](Eigen::Index row) {
    return ArrayOf(shown, [&](Eigen::Index column) { return NumberOrNull(element(row, column)); });
  };
  return {{"names", std::move(shown_names)}, {"matrix", ArrayOf(shown, row_of)}};
}

/// Sums over all recordings.
Json SumJson(const std::string& unit, const FitStatistics& statistics) {
  NumberObject json;
  if (unit != "sigma") json.Set(KeyWithUnit("rms_residual", unit), statistics.rms_residual);
  return json.Set("log_likelihood", statistics.log_likelihood)
      .Set("aic", statistics.aic)
      .Set("aicc", statistics.aicc)
      .Set("bic", statistics.bic)
      .Set("effective_samples", statistics.effective_samples)
      .Done();
}

ShowsParameter Shared(const AcrossRecordings& across) {
  return [&across](std::string_view name) { return std::ranges::find(across.shared, name) != across.shared.end(); };
}

}  // namespace

Json ResolutionJson(const DataSummary& data) { return data.resolution > 0 ? Json(data.resolution) : Json(nullptr); }

Json ParametersJson(const FitReport& fit, const ShowsParameter& shows) {
  Json parameters = Json::object();
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (shows(parameter.info.name)) parameters[std::string(parameter.info.name)] = ParameterJson(parameter);
  }
  return parameters;
}

Json DerivedJson(const FitReport& fit) {
  Json derived = Json::object();
  for (const DerivedQuantity& quantity : fit.derived) {
    NumberObject json;
    json.Set("estimate", quantity.estimate)
        .Set("std_error", quantity.std_error, "a parameter on which it depends has no standard error")
        .Set("interval95", IntervalJson(quantity.lower95, quantity.upper95))
        .Set("unit", Json(quantity.unit));
    if (const auto systematic = quantity.systematic.Total()) {
      json.Set("systematic_std_error", *systematic)
          .Set("total_std_error", NumberOrNull(TotalStdError(quantity.std_error, quantity.systematic)))
          .Set("total_interval95", TotalIntervalJson(quantity))
          .Set("error_budget", ErrorBudgetJson(quantity.std_error, quantity.systematic));
    }
    derived[quantity.name] = json.Done();
  }
  return derived;
}

Json CovarianceJson(const FitReport& fit, const ShowsParameter& shows) {
  return MatrixJson(fit.covariance_names, shows, [&](Eigen::Index i, Eigen::Index j) { return fit.covariance(i, j); });
}

Json CorrelationJson(const FitReport& fit, const ShowsParameter& shows) {
  return MatrixJson(fit.covariance_names, shows,
                    [&](Eigen::Index i, Eigen::Index j) { return Correlation(fit, i, j); });
}

Json SystematicJson(const FitReport& fit, const ShowsParameter& shows) {
  return MatrixJson(fit.systematic_names, shows,
                    [&](Eigen::Index i, Eigen::Index j) { return fit.systematic_covariance(i, j); });
}

Json NoiseJson(const FitReport& fit, const DataSummary& data) {
  const NoiseEstimate& noise = fit.noise;
  NumberObject object;
  object.AddReason(noise.why);
  object.Set("model", Json(NoiseFamilyName(noise.family)))
      .Set(KeyWithUnit("sigma", fit.reading_unit), noise.sigma)
      .Set("sigma_std_error", NumberOrNull(noise.sigma_std_error))
      .Set(KeyWithUnit("resolution", fit.reading_unit), ResolutionJson(data))
      .Set("saturated_samples", Json(noise.censored))
      .Set("lag1_correlation", noise.lag1_correlation)
      .Set("correlation", Json(noise.autocorrelation.Name()));
  if (noise.family == NoiseFamily::kAveraged) object.Set("averaged_readings", Json(noise.averaging.readings));
  if (noise.family == NoiseFamily::kEdges) object.Set("time_sigma_s", noise.stamp_ratio * noise.sigma);
  return object.Done();
}

Json StatisticsJson(const FitReport& fit) {
  const FitStatistics& statistics = fit.statistics;
  return NumberObject()
      .Set(KeyWithUnit("rms_residual", fit.reading_unit), statistics.rms_residual)
      .Set("log_likelihood", statistics.log_likelihood)
      .Set("aic", statistics.aic)
      .Set("aicc", statistics.aicc)
      .Set("bic", statistics.bic)
      .Set("durbin_watson", statistics.durbin_watson)
      .Set("ljung_box_p", statistics.ljung_box_p)
      .Set("runs_p", statistics.runs_p)
      .Set("effective_samples", statistics.effective_samples)
      .Done();
}

Json IdentifiabilityJson(const FitReport& fit, const ShowsParameter& shows) {
  Json all = Json::array();
  for (const Identifiability& known : fit.identifiability) {
    if (!shows(known.parameter)) continue;
    all.push_back({{"parameter", known.parameter},
                   {"verdict", VerdictName(known.verdict)},
                   {"direction", known.direction},
                   {"advice", TextOrNull(known.advice)}});
  }
  return all;
}

nlohmann::ordered_json SolverJson(const SolverSummary& solver) {
  Json attempts = Json::array();
  for (const AttemptRecord& attempt : solver.attempts)
    attempts.push_back({{"name", attempt.name}, {"kept", attempt.kept}});
  return {{"iterations", solver.iterations},
          {"evaluations", solver.evaluations},
          {"termination", solver.termination},
          {"attempts", std::move(attempts)}};
}

nlohmann::ordered_json FitJson(const Identification& identification, std::size_t m) {
  const FitReport& fit = identification.fits[m];
  const AcrossRecordings& across = identification.across[m];
  const ShowsParameter shows = Shared(across);
  const bool failed = fit.termination == Termination::kFailed;
  const bool has_equation = !failed && identification.SharesMotion(m);
  Json json;
  json["model"] = fit.model.name;
  json["status"] = TerminationName(fit.termination);
  json["reason"] = fit.reason;
  json["equation"] = has_equation ? Json(FittedEquation(fit, identification.si_rig())) : Json(nullptr);
  json["shared"] = across.shared;
  json["parameters"] = ParametersJson(fit, shows);
  json["derived"] = DerivedJson(fit);
  json["covariance"] = CovarianceJson(fit, shows);
  json["correlation"] = CorrelationJson(fit, shows);
  json["systematic_covariance"] = SystematicJson(fit, shows);
  json["budget"] = BudgetJson(fit);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["interval_method"] = TextOrNull(fit.interval_method);
  json["identifiability"] = IdentifiabilityJson(fit, shows);
  json["statistics"] = failed ? Json(nullptr) : SumJson(identification.unit, fit.statistics);
  json["homogeneity"] = across.homogeneity ? HomogeneityJson(*across.homogeneity) : Json(nullptr);
  AddAmbiguities(identification, m, json);
  json["solver"] = SolverJson(fit.solver);
  json["summary"] = FitSummaryJson(SummarizeFit(identification, m));
  return json;
}

nlohmann::ordered_json RecordingFitJson(const Identification& identification, std::size_t k, std::size_t m) {
  const FitReport& fit = identification.FitOf(k, m);
  const IdentifiedRecording& recording = identification.recordings[k];
  const AcrossRecordings& across = identification.across[m];
  const ShowsParameter is_own = std::not_fn(Shared(across));
  const bool failed = fit.termination == Termination::kFailed;
  Json json;
  json["model"] = fit.model.name;
  json["amplitude_rad"] = NumberOrNull(across.amplitudes[k]);
  json["parameters"] = ParametersJson(fit, is_own);
  json["covariance"] = CovarianceJson(fit);
  json["correlation"] = CorrelationJson(fit);
  json["systematic_covariance"] = SystematicJson(fit);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["identifiability"] = IdentifiabilityJson(fit, is_own);
  json["noise"] = failed ? Json(nullptr) : NoiseJson(fit, recording.data);
  json["statistics"] = failed ? Json(nullptr) : StatisticsJson(fit);
  json["closed_form"] = CheckJson(recording.CheckOf(m));
  json["constancy"] = ConstancyJson(recording.ConstancyOf(m));
  if (json["constancy"].is_null()) json["constancy_reason"] = NoConstancyReason(fit, recording.ConstancyOf(m));
  if (fit.termination == Termination::kConverged) json["suspicions"] = SuspicionsJson(fit);
  json["separate"] = across.separate[k];
  return json;
}

}  // namespace pendulum
