// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/provenance.h"

#include <array>
#include <cstddef>
#include <fstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/instruction_set.h"
#include "pendulum/base/json.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/recording/sensor_errors.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

Json RangesJson(const ParameterRanges& ranges) {
  Json json = Json::object();
  for (const auto& [name, range] : ranges) json[name] = {NumberOrNull(range.lower), NumberOrNull(range.upper)};
  return json;
}

Json PriorsJson(const ParameterPriors& priors) {
  Json json = Json::object();
  for (const auto& [name, prior] : priors) json[name] = {prior.mean, prior.std_dev};
  return json;
}

Json ReadJson(const ReadOptions& read) {
  Json json = {{"time_column", read.time_column},
               {"value_column", read.value_column},
               {"unit", read.unit},
               {"sample_rate_hz", read.sample_rate_hz}};
  json["resolution"] = read.resolution ? Json(*read.resolution) : Json(nullptr);
  json["range"] = read.range ? Json{read.range->low, read.range->high} : Json(nullptr);
  // Without these flags the hash is that of earlier versions.
  if (read.oversample > 0) json["oversample"] = read.oversample;
  if (const auto& window = read.averaging_window) json["window_s"] = {window->from, window->to};
  return json;
}

Json SensorJson(const SensorStatement& sensor) {
  Json json = {{"kind", sensor.kind}};
  for (const SensorEffect effect : kSensorEffects) {
    if (const auto& size = sensor.std_devs[static_cast<std::size_t>(effect)]) json[SensorEffectName(effect)] = *size;
  }
  return json;
}

/// Enumerations without names are stored by number. New values must be appended, otherwise the hash of unchanged
/// options changes. may_be_spring is not among them: a batch fits the models that it
/// was asked for.
Json FitJson(const FitOptions& fit) {
  return {{"gravity", fit.gravity ? Json(fit.gravity->name()) : Json(nullptr)},
          {"start", fit.start ? Json(*fit.start == StartKind::kRelease ? "release" : "moving") : Json(nullptr)},
          {"fix", fit.fixed},
          {"init", fit.initial},
          {"bounds", RangesJson(fit.bounds)},
          {"prior", PriorsJson(fit.priors)},
          {"noise", fit.noise ? Json(NoiseFamilyName(*fit.noise)) : Json(nullptr)},
          {"interval", static_cast<int>(fit.interval)},
          {"seed", fit.seed},
          {"max_trace_error", fit.search.max_trace_error},
          {"max_iterations", fit.search.max_iterations},
          {"max_traces", fit.search.max_traces}};
}

std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

}  // namespace

bool Provenance::Agrees(const Provenance& other) const {
  return data_sha256 == other.data_sha256 && rig_sha256 == other.rig_sha256 &&
         calibration_sha256 == other.calibration_sha256 && options_sha256 == other.options_sha256 &&
         version == other.version;
}

std::string OptionsJson(const IdentifyOptions& options) {
  const SwingChoice& swing = options.swing;
  Json json = {{"models", options.models},
               {"from_s", NumberOrNull(swing.from)},
               {"to_s", NumberOrNull(swing.to)},
               {"release", swing.release},
               {"closed_form_only", options.closed_form_only},
               {"checks", static_cast<int>(options.checks)},
               {"read", ReadJson(options.read)},
               {"fit", FitJson(options.fit)}};
  // Without flags for the rig the hash is that of earlier versions.
  if (!options.rig_values.empty()) json["rig_values"] = options.rig_values;
  if (options.sensor) json["sensor"] = SensorJson(*options.sensor);
  return JsonText(json);
}

const std::string& CpuType() {
  constexpr std::array<std::string_view, 3> kForms = {"baseline", "avx2", "avx512"};
  static const std::string type =
      ProcessorName() + " (" + std::string(kForms.at(static_cast<std::size_t>(kInstructionSet))) + ")";
  return type;
}

}  // namespace pendulum
