// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/report/closed_form_text.h"
#include "pendulum/report/comparison_text.h"
#include "pendulum/report/data_sections.h"
#include "pendulum/report/fit_sections.h"
#include "pendulum/report/summary_text.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

void Append(Sections more, Sections& sections) {
  sections.insert(sections.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

constexpr const char* kWarningTitle = "Warnings";

Sections WarningSections(const Identification& identification) {
  Items items{{}, Emphasis::kCaution};
  for (const Warning& warning : AllWarnings(identification)) items.texts.push_back(Printable(MessageText(warning)));
  if (items.texts.empty()) return {};
  return {{kWarningTitle, "", {std::move(items)}}};
}

}  // namespace

Sections ReportSections(const Identification& identification, FitsInFull which) {
  Sections sections = DataSections(identification);
  Append(ComparisonSections(identification), sections);
  for (std::size_t i = 0; i < identification.fits.size(); ++i) {
    if (which == FitsInFull::kMain && !identification.IsShownInFull(i)) continue;
    Sections of_fit = FitSections(identification, i);
    for (Section& section : of_fit) section.law = which == FitsInFull::kAll ? identification.fits[i].model.name : "";
    Append(std::move(of_fit), sections);
  }
  for (std::size_t i = 0; i < identification.fits.size() && which == FitsInFull::kMain; ++i) {
    if (!identification.IsShownInFull(i)) sections.push_back(ParameterSection(identification.fits[i], true));
  }
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    Append(OfRecording(identification, k, ClosedFormSections(identification, k, which)), sections);
  }
  Append(WarningSections(identification), sections);
  return sections;
}

std::string ToText(const Identification& identification, TextStyle style) {
  Sections sections = ReportSections(identification);
  std::ranges::reverse(sections);
  std::ranges::stable_partition(sections, [](const Section& section) { return section.title != kWarningTitle; });
  ResultSummary summary = SummarizeResult(identification);
  summary.fit.warnings.clear();  // the section above has them in full
  sections.push_back(SummarySection(summary));
  return ToText(sections, style);
}

}  // namespace pendulum
