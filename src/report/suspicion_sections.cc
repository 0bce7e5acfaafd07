// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/suspicion_sections.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/recording/sensor_errors.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

std::string InWords(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

Section SuggestedSection(const FitReport& fit) {
  Section section{"What the residuals suggest"};
  if (fit.suspicions.empty()) {
    section.AddText("No cause outside the law is significant.");
    return section;
  }
  Table table{{{"cause"}, {"size", true}, {"significance", true}, {"estimates"}, {"what to do"}}};
  for (const Suspicion& suspicion : fit.suspicions) {
    table.rows.push_back({InWords(CauseName(suspicion.cause)), SizeText(suspicion),
                          NumberText(suspicion.significance, 2), suspicion.is_corrected ? "corrected" : "not corrected",
                          AdviceFor(suspicion.cause)});
  }
  section.Add(std::move(table));
  return section;
}

/// The unit of an effect's size, for readings in a unit.
std::string UnitOfEffect(SensorEffect effect, const std::string& reading_unit) {
  if (effect == SensorEffect::kGain || effect == SensorEffect::kClock) return "1";
  return effect == SensorEffect::kLag ? "s" : reading_unit;
}

Section SensorSection(const SensorErrors& sensor, const std::string& reading_unit) {
  Section section{"What the sensor may do (" + sensor.kind + ")"};
  Table table{{{"effect"}, {"standard deviation", true}, {"source"}}};
  for (const SensorEffect effect : kSensorEffects) {
    const EffectSize& size = sensor.Of(effect);
    table.rows.push_back({InWords(SensorEffectName(effect)),
                          size.std_dev > 0 ? PlainSizeText(size.std_dev, UnitOfEffect(effect, reading_unit)) : "0",
                          size.source});
  }
  section.Add(std::move(table));
  return section;
}

}  // namespace

Sections SuspicionSections(const FitReport& fit) {
  if (fit.termination != Termination::kConverged) return {};
  return {SuggestedSection(fit)};
}

Sections SensorSections(const FitReport& fit, const SensorErrors& sensor) {
  if (fit.termination != Termination::kConverged || sensor.kind.empty()) return {};
  return {SensorSection(sensor, fit.reading_unit)};
}

nlohmann::ordered_json SuspicionsJson(const FitReport& fit) {
  nlohmann::ordered_json suspicions = nlohmann::ordered_json::array();
  for (const Suspicion& suspicion : fit.suspicions) {
    suspicions.push_back(NumberObject()
                             .Set("name", nlohmann::ordered_json(CauseName(suspicion.cause)))
                             .Set("size", suspicion.size)
                             .Set("std_error", suspicion.std_error)
                             .Set("unit", nlohmann::ordered_json(suspicion.unit))
                             .Set("significance", suspicion.significance)
                             .Set("corrected", nlohmann::ordered_json(suspicion.is_corrected))
                             .Done());
  }
  return suspicions;
}

std::string SuspectedText(const FitReport& fit, bool corrected) {
  std::string text;
  for (const Suspicion& suspicion : fit.suspicions) {
    if (suspicion.is_corrected != corrected) continue;
    const std::string flag(corrected ? "" : FlagFor(suspicion.cause));
    text += (text.empty() ? "" : ", ") + InWords(CauseName(suspicion.cause)) + " " + SizeText(suspicion) +
            (flag.empty() ? "" : " (" + flag + ")");
  }
  return text;
}

}  // namespace pendulum
