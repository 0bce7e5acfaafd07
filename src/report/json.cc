// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "pendulum/base/json.h"
#include "pendulum/base/version.h"
#include "pendulum/report/closed_form_json.h"
#include "pendulum/report/comparison_json.h"
#include "pendulum/report/fit_json.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 3;

std::string WindowReason(const DataSummary& data) {
  return data.begins.empty() ? "" : "begins: " + data.begins + "; ends: " + data.ends;
}

Json LeftOutJson(const std::optional<LeftOut>& left_out) {
  if (!left_out) return nullptr;
  return {{"half_swings", left_out->half_swings},
          {"of", left_out->all},
          {"includes_largest", left_out->is_largest},
          {"larger_errors", left_out->larger_errors}};
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
                                                   {"source", TextOrNull(size.SourceText())}};
  }
  return json;
}

/// How the motion of the main fit begins; null without a fit.
Json StartJson(const Identification& identification, std::size_t k) {
  if (identification.fits.empty()) return nullptr;
  return identification.FitOf(k, identification.MainFit()).start == StartKind::kRelease ? "release" : "moving";
}

Json RecordingJson(const Identification& identification, std::size_t k) {
  const IdentifiedRecording& recording = identification.recordings[k];
  const DataSummary& data = recording.data;
  Json fits = Json::array();
  for (std::size_t m = 0; m < identification.fits.size(); ++m) fits.push_back(RecordingFitJson(identification, k, m));
  NumberObject json;
  json.Set("path", TextOrNull(data.path))
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
      .Set("left_out", LeftOutJson(data.left_out))
      .Set("releases", Json(data.releases))
      .Set("release", data.release > 0 ? Json(data.release) : Json(nullptr))
      .Set("start", StartJson(identification, k))
      .Set("sampling", SamplingJson(recording.sampling))
      .Set("calibration", recording.calibration)
      .Set("closed_forms", ClosedFormsJson(recording, identification.si_rig()))
      .Set("fits", std::move(fits));
  if (!recording.closed_forms && !recording.no_closed_forms.empty()) json.AddReason(recording.no_closed_forms);
  return json.Done();
}

Json WarningsJson(const Identification& identification) {
  Json warnings = Json::array();
  for (const Warning& warning : AllWarnings(identification)) {
    const WarningSubject& about = warning.about;
    Json recordings = Json::array();
    for (int k = 1; k <= static_cast<int>(identification.recordings.size()); ++k) {
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

}  // namespace

nlohmann::ordered_json ToJson(const Identification& identification) {
  Json recordings = Json::array(), fits = Json::array();
  for (std::size_t k = 0; k < identification.recordings.size(); ++k)
    recordings.push_back(RecordingJson(identification, k));
  for (std::size_t m = 0; m < identification.fits.size(); ++m) fits.push_back(FitJson(identification, m));
  return {{"schema_version", kSchemaVersion},
          {"tool", {{"name", "fit_pendulum"}, {"version", kVersion}}},
          {"rig", identification.rig ? identification.rig->source : Json(nullptr)},
          {"recordings", std::move(recordings)},
          {"fits", std::move(fits)},
          {"comparison", ComparisonJson(identification)},
          {"warnings", WarningsJson(identification)}};
}

std::string ToJsonText(const Identification& identification) {
  constexpr int kIndent = 2;
  return JsonText(ToJson(identification), kIndent) + "\n";
}

}  // namespace pendulum
