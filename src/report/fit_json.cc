// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_json.h"

#include <optional>
#include <utility>

#include "pendulum/report/json_parts.h"

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

Json ParameterJson(const ParameterEstimate& parameter) {
  NumberObject object;
  if (parameter.open_interval != OpenInterval::kClosed) {
    object.AddReason("the interval is open: " + std::string(Sentence(parameter.open_interval)));
  }
  if (parameter.unseen_friction) object.Set("unseen_friction_std_error", *parameter.unseen_friction);
  return object.Set("estimate", parameter.estimate)
      .Set("std_error", parameter.std_error, parameter.reason.empty() ? "not estimated" : parameter.reason)
      .Set("interval95", IntervalJson(parameter.lower95, parameter.upper95))
      .Set("systematic_std_error", NumberOrNull(parameter.systematic.Total()))
      .Set("total_std_error", NumberOrNull(TotalStdError(parameter.std_error, parameter.systematic)))
      .Set("error_budget", ErrorBudgetJson(parameter.std_error, parameter.systematic))
      .Set("unit", Json(parameter.unit))
      .Set("fixed", Json(parameter.fixed))
      .Set("at_bound", Json(parameter.at_bound))
      .Done();
}

template <typename Element>
Json MatrixJson(const std::vector<std::string>& names, const Element& element) {
  Json matrix = Json::array();
  for (Eigen::Index row = 0; row < static_cast<Eigen::Index>(names.size()); ++row) {
    Json values = Json::array();
    for (Eigen::Index column = 0; column < static_cast<Eigen::Index>(names.size()); ++column) {
      values.push_back(NumberOrNull(element(row, column)));
    }
    matrix.push_back(std::move(values));
  }
  return {{"names", names}, {"matrix", std::move(matrix)}};
}

}  // namespace

Json ResolutionJson(const DataSummary& data) { return data.resolution > 0 ? Json(data.resolution) : Json(nullptr); }

Json ParametersJson(const FitReport& fit) {
  Json parameters = Json::object();
  for (const ParameterEstimate& parameter : fit.parameters) {
    parameters[std::string(parameter.info.name)] = ParameterJson(parameter);
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
          .Set("error_budget", ErrorBudgetJson(quantity.std_error, quantity.systematic));
    }
    derived[quantity.name] = json.Done();
  }
  return derived;
}

Json CovarianceJson(const FitReport& fit) {
  return MatrixJson(fit.covariance_names, [&](Eigen::Index i, Eigen::Index j) { return fit.covariance(i, j); });
}

Json CorrelationJson(const FitReport& fit) {
  return MatrixJson(fit.covariance_names, [&](Eigen::Index i, Eigen::Index j) { return Correlation(fit, i, j); });
}

Json SystematicJson(const FitReport& fit) {
  return MatrixJson(fit.systematic_names,
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

Json IdentifiabilityJson(const FitReport& fit) {
  Json all = Json::array();
  for (const Identifiability& known : fit.identifiability) {
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

}  // namespace pendulum
