// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/joint_json.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pendulum/model/motion_model.h"
#include "pendulum/report/ambiguity_sections.h"
#include "pendulum/report/closed_form_json.h"
#include "pendulum/report/comparison_json.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/fit_json.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/result_summary.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

Json RandomEffectsJson(const RandomEffects& scatter) {
  return NumberObject()
      .Set("mean", scatter.mean)
      .Set("std_error", scatter.std_error)
      .Set("interval95", IntervalJson(scatter.lower95, scatter.upper95))
      .Set("between_std_dev", scatter.between)
      .Set("between_interval95", IntervalJson(scatter.between_lower95, scatter.between_upper95))
      .Done();
}

Json SharedParameterJson(const SharedParameter& parameter) {
  Json runs = Json::array();
  for (const RunEstimate& run : parameter.runs) {
    runs.push_back(NumberObject()
                       .Set("estimate", run.value, "the recording on its own does not determine it")
                       .Set("std_error", run.std_error, "the recording on its own does not determine it")
                       .Set("z", run.z, "no other recording determines it")
                       .Done());
  }
  return NumberObject()
      .Set("unit", Json(parameter.unit))
      .Set("statistic", parameter.statistic)
      .Set("dof", Json(parameter.dof))
      .Set("p", parameter.p)
      .Set("mean", parameter.mean)
      .Set("std_error", parameter.std_error)
      .Set("random_effects", RandomEffectsJson(parameter.scatter))
      .Set("runs", std::move(runs))
      .Done();
}

Json AmplitudeJson(const AmplitudeDependence& dependence) {
  return NumberObject()
      .Set("parameter", Json(dependence.name))
      .Set("slope", dependence.slope)
      .Set("std_error", dependence.slope_std_error)
      .Set("unit", Json(dependence.unit + " / rad^2"))
      .Set("p", dependence.p)
      .Set("span", dependence.span)
      .Set("p_of_remainder", dependence.rest_p)
      .Done();
}

Json HomogeneityJson(const Homogeneity& homogeneity) {
  Json disagreeing = Json::array();
  for (const int run : homogeneity.disagreeing) disagreeing.push_back(run + 1);
  Json parameters = Json::object();
  for (const SharedParameter& parameter : homogeneity.parameters) {
    parameters[parameter.name] = SharedParameterJson(parameter);
  }
  Json amplitude = Json::array();
  for (const AmplitudeDependence& one : homogeneity.amplitude_dependence) amplitude.push_back(AmplitudeJson(one));
  NumberObject json;
  if (!homogeneity.p && !homogeneity.reason.empty()) json.AddReason(homogeneity.reason);
  json.Set("statistic", homogeneity.p ? Json(homogeneity.statistic) : Json(nullptr))
      .Set("dof", Json(homogeneity.dof))
      .Set("p", NumberOrNull(homogeneity.p))
      .Set("agrees", homogeneity.p ? Json(homogeneity.agrees()) : Json(nullptr))
      .Set("outliers", std::move(disagreeing))
      .Set("verdict", Json(homogeneity.verdict))
      .Set("parameters", std::move(parameters))
      .Set("amplitude_dependence", std::move(amplitude));
  return json.Done();
}

/// One recording's part of the joint fit.
Json RunJson(const Identification& identification, std::size_t index, std::size_t k) {
  const Identification& run = identification.runs[k];
  const FitReport& fit = run.fits[index];
  const bool failed = fit.termination == Termination::kFailed;
  Json json;
  json["path"] = TextOrNull(run.data.path);
  json["release"] = run.data.release > 0 ? Json(run.data.release) : Json(nullptr);
  json["amplitude_rad"] = NumberOrNull(identification.joint[index].homogeneity.amplitudes[k]);
  json["parameters"] = ParametersJson(fit);
  json["covariance"] = CovarianceJson(fit);
  json["correlation"] = CorrelationJson(fit);
  json["systematic_covariance"] = SystematicJson(fit);
  json["noise"] = failed ? Json(nullptr) : NoiseJson(fit, run.data);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["identifiability"] = IdentifiabilityJson(fit);
  json["statistics"] = failed ? Json(nullptr) : StatisticsJson(fit);
  json["closed_form"] = CheckJson(run.CheckOf(index));
  json["constancy"] = ConstancyJson(run.ConstancyOf(index));
  if (json["constancy"].is_null()) json["constancy_reason"] = NoConstancyReason(fit, run.ConstancyOf(index));
  json["separate"] = identification.joint[index].alone[k];
  return json;
}

/// Sums over all recordings.
Json WholeStatisticsJson(const Identification& identification, const FitReport& fit) {
  const std::string& unit = identification.data.unit;
  NumberObject json;
  if (unit != "sigma") json.Set(KeyWithUnit("rms_residual", unit), fit.statistics.rms_residual);
  return json.Set("log_likelihood", fit.statistics.log_likelihood)
      .Set("aic", fit.statistics.aic)
      .Set("aicc", fit.statistics.aicc)
      .Set("bic", fit.statistics.bic)
      .Set("effective_samples", fit.statistics.effective_samples)
      .Done();
}

/// The equation with its numbers; null unless all physical parameters are shared and the fit succeeded.
Json EquationJson(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  const bool whole = identification.joint[index].shared.size() == PhysicalParameters(fit.model).size();
  return whole && fit.termination != Termination::kFailed ? Json(FittedEquation(fit, identification.si_rig()))
                                                          : Json(nullptr);
}

}  // namespace

Json JointFitJson(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  const bool failed = fit.termination == Termination::kFailed;
  Json runs = Json::array();
  for (std::size_t k = 0; k < identification.runs.size(); ++k) runs.push_back(RunJson(identification, index, k));
  Json json;
  json["model"] = fit.model.name;
  json["status"] = TerminationName(fit.termination);
  json["reason"] = fit.reason;
  json["equation"] = EquationJson(identification, index);
  json["shared"] = identification.joint[index].shared;
  json["parameters"] = ParametersJson(fit);
  json["derived"] = DerivedJson(fit);
  json["covariance"] = CovarianceJson(fit);
  json["correlation"] = CorrelationJson(fit);
  json["systematic_covariance"] = SystematicJson(fit);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["interval_method"] = TextOrNull(fit.interval_method);
  json["identifiability"] = IdentifiabilityJson(fit);
  json["statistics"] = failed ? Json(nullptr) : WholeStatisticsJson(identification, fit);
  json["homogeneity"] = HomogeneityJson(identification.joint[index].homogeneity);
  AddAmbiguities(identification, index, json);
  json["runs"] = std::move(runs);
  json["solver"] = SolverJson(fit.solver);
  json["summary"] = FitSummaryJson(SummarizeFit(identification, index));
  return json;
}

}  // namespace pendulum
