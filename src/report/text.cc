// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/report/ambiguity_sections.h"
#include "pendulum/report/closed_form_text.h"
#include "pendulum/report/comparison_text.h"
#include "pendulum/report/fit_sections.h"
#include "pendulum/report/joint_sections.h"
#include "pendulum/report/summary_text.h"
#include "pendulum/report/suspicion_sections.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

/// The free swings of the recording; the fitted one is marked.
std::string ReleasesText(const DataSummary& data) {
  std::string text;
  for (std::size_t i = 0; i < data.releases.size(); ++i) {
    const auto [from, to] = data.releases[i];
    text += (i == 0 ? "" : ", ") + std::to_string(i + 1) + ": " + NumberText(from, 4) + " s to " + NumberText(to, 4) +
            " s" + (static_cast<int>(i) + 1 == data.release ? " (this one)" : "");
  }
  return text;
}

std::string SourceText(const DataSummary& data) {
  if (data.resolution_source == "found") return ", found in the values";
  return data.resolution_source.empty() ? "" : data.resolution_source == "file" ? ", from the file" : ", as given";
}

Section DataSection(const DataSummary& data) {
  Facts facts;
  if (!data.path.empty()) facts.push_back({"file", Printable(data.path)});
  facts.push_back({"samples", std::to_string(data.used_samples) + " used of " + std::to_string(data.samples)});
  facts.push_back({"window", NumberText(data.from, kTextDigits) + " s to " + NumberText(data.to, kTextDigits) + " s, " +
                                 NumberText(data.sample_rate(), kTextDigits) + " Hz on average"});
  if (!data.begins.empty()) {
    facts.push_back({"begins", data.begins});
    facts.push_back({"ends", data.ends});
  }
  if (data.clock_scale != 1 || data.clock_scale_std_dev > 0) {
    const ValueAndError scale = PdgText(data.clock_scale, data.clock_scale_std_dev);
    facts.push_back({"clock", scale.value + (scale.error.empty() ? "" : " ± " + scale.error) +
                                  " true seconds to its second; parameters are in true seconds"});
  }
  if (data.releases.size() > 1) facts.push_back({"releases", ReleasesText(data)});
  if (data.resolution > 0) facts.push_back({"resolution", ReadingText(data.resolution, data.unit) + SourceText(data)});
  return {"Data", "", {std::move(facts)}};
}

void Append(Sections more, Sections& sections) {
  sections.insert(sections.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

constexpr const char* kWarningTitle = "Warnings";

Section WarningSection(const Identification& identification) {
  Items items{{}, Emphasis::kCaution};
  for (const Warning& warning : AllWarnings(identification)) items.texts.push_back(Printable(MessageText(warning)));
  return {kWarningTitle, "", {std::move(items)}};
}

}  // namespace

Sections ReportSections(const Identification& identification) {
  if (identification.is_joint()) {
    Sections joint = JointSections(identification);
    if (!AllWarnings(identification).empty()) joint.push_back(WarningSection(identification));
    return joint;
  }
  Sections sections = {DataSection(identification.data)};
  Append(SamplingSections(identification), sections);
  Append(ComparisonSections(identification), sections);
  for (std::size_t i = 0; i < identification.fits.size(); ++i) {
    if (!identification.IsShownInFull(i)) continue;
    Append(FitSections(identification.fits[i], identification.si_rig(), identification.CheckOf(i)), sections);
    Append(ConstancySections(identification, i), sections);
    Append(SuspicionSections(identification, i), sections);
    Append(AmbiguitySections(identification, i), sections);
  }
  for (std::size_t i = 0; i < identification.fits.size(); ++i) {
    if (!identification.IsShownInFull(i)) sections.push_back(ParameterSection(identification.fits[i], true));
  }
  Append(ClosedFormSections(identification), sections);
  if (!AllWarnings(identification).empty()) sections.push_back(WarningSection(identification));
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
