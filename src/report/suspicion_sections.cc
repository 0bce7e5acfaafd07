// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/suspicion_sections.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

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

}  // namespace

Sections SuspicionSections(const FitReport& fit) {
  if (fit.termination != Termination::kConverged) return {};
  return {SuggestedSection(fit)};
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
