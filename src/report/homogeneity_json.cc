// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/homogeneity_json.h"

#include <string>
#include <utility>

#include "pendulum/base/rounding.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

Json RandomEffectsJson(const RandomEffects& scatter) {
  return NumberObject()
      .Set("mean", scatter.mean)
      .Set("std_error", scatter.std_error)
      .Set("text", Json(PlusMinusText(scatter.mean, scatter.std_error)))
      .Set("interval95", IntervalJson(scatter.lower95, scatter.upper95))
      .Set("between_std_dev", scatter.between)
      .Set("between_interval95", IntervalJson(scatter.between_lower95, scatter.between_upper95))
      .Done();
}

Json SharedParameterJson(const SharedParameter& parameter) {
  Json recordings = Json::array();
  for (const RunEstimate& run : parameter.runs) {
    recordings.push_back(
        NumberObject()
            .Set("estimate", run.value, "the recording on its own does not determine it")
            .Set("std_error", run.std_error, "the recording on its own does not determine it")
            .Set("text", run.value ? Json(PlusMinusText(*run.value, run.std_error.value_or(0))) : Json(nullptr))
            .Set("z", run.z, "no other recording determines it")
            .Done());
  }
  return NumberObject()
      .Set("unit", Json(parameter.unit))
      .Set("statistic", parameter.statistic)
      .Set("dof", Json(parameter.dof))
      .Set("p", parameter.p)
      .Set("agrees", Json(parameter.agrees()))
      .Set("mean", parameter.mean)
      .Set("std_error", parameter.std_error)
      .Set("random_effects", RandomEffectsJson(parameter.scatter))
      .Set("recordings", std::move(recordings))
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

}  // namespace

nlohmann::ordered_json HomogeneityJson(const Homogeneity& homogeneity) {
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

}  // namespace pendulum
