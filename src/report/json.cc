// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "pendulum/base/json.h"
#include "pendulum/base/version.h"
#include "pendulum/report/ambiguity_sections.h"
#include "pendulum/report/closed_form_json.h"
#include "pendulum/report/comparison_json.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/fit_json.h"
#include "pendulum/report/joint_json.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/result_summary.h"
#include "pendulum/report/suspicion_sections.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 2;

std::string WindowReason(const DataSummary& data) {
  return data.begins.empty() ? "" : "begins: " + data.begins + "; ends: " + data.ends;
}

Json StartJson(const Identification& identification) {
  if (identification.fits.empty()) return nullptr;
  return identification.fits.front().start == StartKind::kRelease ? "release" : "moving";
}

/// Null if nothing was decided about the sensor.
Json SensorErrorsJson(const DataSummary& data) {
  if (data.sensor.kind.empty()) return nullptr;
  Json json = {{"kind", data.sensor.kind}};
  for (const SensorEffect effect : kSensorEffects) {
    const EffectSize& size = data.sensor.Of(effect);
    const bool is_relative = effect == SensorEffect::kGain || effect == SensorEffect::kClock;
    json[std::string(SensorEffectName(effect))] = {{"std_dev", size.std_dev},
                                                   {"unit", is_relative                    ? "1"
                                                            : effect == SensorEffect::kLag ? "s"
                                                                                           : data.unit},
                                                   {"source", TextOrNull(size.source)}};
  }
  return json;
}

Json DataJson(const Identification& identification) {
  const DataSummary& data = identification.data;
  return NumberObject()
      .Set("path", TextOrNull(data.path))
      .Set("sha256", TextOrNull(data.sha256))
      .Set("samples", Json(data.samples))
      .Set("used_samples", Json(data.used_samples))
      .Set("duration_s", data.duration())
      .Set("sample_rate_hz", data.sample_rate())
      .Set(KeyWithUnit("resolution", data.unit), ResolutionJson(data))
      .Set("resolution_source", TextOrNull(data.resolution_source))
      .Set("clock_scale", data.clock_scale)
      .Set("clock_scale_std_dev", data.clock_scale_std_dev)
      .Set("sensor", SensorErrorsJson(data))
      .Set("window_s", Json::array({data.from, data.to}))
      .Set("window_reason", TextOrNull(WindowReason(data)))
      .Set("releases", Json(data.releases))
      .Set("release", data.release > 0 ? Json(data.release) : Json(nullptr))
      .Set("start", StartJson(identification))
      .Set("sampling", SamplingJson(identification.sampling))
      .Done();
}

/// Missing parts of a failed fit are null; its `reason` says why.
Json FitJson(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  const bool failed = fit.termination == Termination::kFailed;
  Json json;
  json["model"] = fit.model.name;
  json["status"] = TerminationName(fit.termination);
  json["reason"] = fit.reason;
  json["equation"] = failed ? Json(nullptr) : Json(FittedEquation(fit, identification.si_rig()));
  json["parameters"] = ParametersJson(fit);
  json["derived"] = DerivedJson(fit);
  json["covariance"] = CovarianceJson(fit);
  json["correlation"] = CorrelationJson(fit);
  json["noise"] = failed ? Json(nullptr) : NoiseJson(fit, identification.data);
  json["systematic_covariance"] = SystematicJson(fit);
  json["std_error_method"] = TextOrNull(fit.std_error_method);
  json["interval_method"] = TextOrNull(fit.interval_method);
  json["identifiability"] = IdentifiabilityJson(fit);
  json["statistics"] = failed ? Json(nullptr) : StatisticsJson(fit);
  json["closed_form"] = CheckJson(identification.CheckOf(index));
  json["constancy"] = ConstancyJson(identification.ConstancyOf(index));
  if (json["constancy"].is_null()) json["constancy_reason"] = NoConstancyReason(fit, identification.ConstancyOf(index));
  AddAmbiguities(identification, index, json);
  if (fit.termination == Termination::kConverged) json["suspicions"] = SuspicionsJson(fit);
  json["solver"] = SolverJson(fit.solver);
  json["summary"] = FitSummaryJson(SummarizeFit(identification, index));
  return json;
}

Json WarningsJson(const Identification& identification) {
  Json warnings = Json::array();
  for (const Warning& warning : AllWarnings(identification)) {
    const WarningSubject& about = warning.about;
    Json recordings = Json::array();
    for (int k = 1; k <= static_cast<int>(identification.runs.size()); ++k) {
      if (about.recording == k || about.recording == WarningSubject::kEachRecording) recordings.push_back(k);
    }
    warnings.push_back({{"code", warning.code.text()},
                        {"message", MessageText(warning)},
                        {"text", TextWithoutLaw(warning)},
                        {"finding", warning.finding},
                        {"explanation", TextOrNull(warning.explanation)},
                        {"advice", TextOrNull(warning.advice)},
                        {"flags", warning.flags},
                        {"assumed", TextOrNull(warning.assumed)},
                        {"law", TextOrNull(about.law)},
                        {"recordings", std::move(recordings)},
                        {"parameters", about.parameters}});
  }
  return warnings;
}

Json CalibrationJson(const Identification& identification) { return identification.calibration; }

/// For one recording the part itself; for a joint fit an array with one per recording, in order.
template <typename Part>
Json JsonPerRecording(const Identification& identification, const Part& part) {
  if (!identification.is_joint()) return part(identification);
  Json all = Json::array();
  for (const Identification& run : identification.runs) all.push_back(part(run));
  return all;
}

std::string NoClosedFormsReason(const Identification& identification) {
  std::string why = identification.closed_forms || identification.is_joint() ? "" : identification.no_closed_forms;
  for (std::size_t k = 0; k < identification.runs.size(); ++k) {
    if (identification.runs[k].closed_forms) continue;
    why +=
        (why.empty() ? "" : "; ") + RecordingLabel(identification, k) + ": " + identification.runs[k].no_closed_forms;
  }
  return why;
}

}  // namespace

nlohmann::ordered_json ToJson(const Identification& identification) {
  Json fits = Json::array();
  for (std::size_t i = 0; i < identification.fits.size(); ++i) {
    fits.push_back(identification.is_joint() ? JointFitJson(identification, i) : FitJson(identification, i));
  }
  NumberObject json;
  json.Set("schema_version", Json(kSchemaVersion))
      .Set("tool", Json{{"name", "fit_pendulum"}, {"version", kVersion}})
      .Set("data", JsonPerRecording(identification, DataJson))
      .Set("rig", identification.rig ? identification.rig->source : Json(nullptr))
      .Set("calibration", JsonPerRecording(identification, CalibrationJson))
      .Set("fits", std::move(fits))
      .Set("comparison", ComparisonJson(identification))
      .Set("closed_forms", JsonPerRecording(identification, ClosedFormsJson))
      .Set("warnings", WarningsJson(identification));
  const std::string why = NoClosedFormsReason(identification);
  if (!why.empty()) json.AddReason(why);
  return json.Done();
}

std::string ToJsonText(const Identification& identification) {
  constexpr int kIndent = 2;
  return JsonText(ToJson(identification), kIndent) + "\n";
}

}  // namespace pendulum
