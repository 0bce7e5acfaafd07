// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/ambiguity_sections.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/analysis/ambiguities.h"
#include "pendulum/analysis/rig_verdict.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

std::string AsSentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return Printable(text) + ".";
}

Json RigVerdictJson(const RigVerdict& verdict) {
  return NumberObject()
      .Set("geometric", verdict.geometric)
      .Set("fitted", verdict.fitted)
      .Set("excess", verdict.excess)
      .Set("z", verdict.z, verdict.text())
      .Set("agrees", verdict.z ? Json(!verdict.differs()) : Json(nullptr))
      .Set("verdict", Json(verdict.text()))
      .Done();
}

}  // namespace

Sections AmbiguitySections(const Identification& identification, std::size_t fit) {
  const FitReport& report = identification.fits[fit];
  const std::vector<Ambiguity> ambiguities = AmbiguitiesOf(report, identification.rig);
  if (ambiguities.empty()) return {};
  Section section{"What one swing cannot tell"};
  if (const auto verdict = JudgeInertia(identification.rig, report)) {
    section.AddText(AsSentence(verdict->text()), verdict->differs() ? Emphasis::kCaution : Emphasis::kNone);
  }
  Items items;
  for (const Ambiguity& one : ambiguities) {
    items.texts.push_back(AsSentence(one.cause + ": " + one.meaning) + " " + AsSentence(one.experiment));
  }
  section.Add(std::move(items));
  return {std::move(section)};
}

void AddAmbiguities(const Identification& identification, std::size_t fit, nlohmann::ordered_json& json) {
  const FitReport& report = identification.fits[fit];
  if (const auto verdict = JudgeInertia(identification.rig, report)) json["rig_verdict"] = RigVerdictJson(*verdict);
  const std::vector<Ambiguity> ambiguities = AmbiguitiesOf(report, identification.rig);
  for (const Ambiguity& one : ambiguities) {
    json["ambiguities"].push_back({{"cause", one.cause}, {"meaning", one.meaning}, {"experiment", one.experiment}});
  }
}

}  // namespace pendulum
