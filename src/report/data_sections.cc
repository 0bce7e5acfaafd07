// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/data_sections.h"

#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/model/rig.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/report/closed_form_text.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

std::string WindowText(double from, double to) {
  const auto [begin, end] = SpanTexts(from, to);
  return begin + " s to " + end + " s";
}

/// The free swings of the recording; the fitted one is marked.
std::string ReleasesText(const DataSummary& data) {
  std::string text;
  for (std::size_t i = 0; i < data.releases.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(i + 1) + ": " + WindowText(data.releases[i][0], data.releases[i][1]) +
            (static_cast<int>(i) + 1 == data.release ? " (this one)" : "");
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
  facts.push_back({"window", WindowText(data.from, data.to) + ", " + NumberText(data.sample_rate(), kTextDigits) +
                                 " Hz on average"});
  if (!data.begins.empty()) {
    facts.push_back({"begins", data.begins});
    facts.push_back({"ends", data.ends});
  }
  if (data.left_out) facts.push_back({"left out", Sentence(*data.left_out)});
  if (data.clock_scale != 1 || data.clock_scale_std_dev > 0) {
    const ValueAndError scale = PdgText(data.clock_scale, data.clock_scale_std_dev);
    facts.push_back({"clock", scale.value + (scale.error.empty() ? "" : " ± " + scale.error) +
                                  " true seconds to its second; parameters are in true seconds"});
  }
  if (data.releases.size() > 1) facts.push_back({"releases", ReleasesText(data)});
  if (data.resolution > 0) facts.push_back({"resolution", ReadingText(data.resolution, data.unit) + SourceText(data)});
  return {"Data", "", {std::move(facts)}};
}

// ---- Several recordings ---------------------------------------------------------------------------------------------

std::string FileText(const DataSummary& data, bool several_releases) {
  const std::string path = data.path.empty() ? "-" : Printable(data.path);
  return several_releases && data.release > 0 ? path + ", swing " + std::to_string(data.release) : path;
}

Section RecordingSection(const Identification& identification) {
  Table files{{{""}, {"file"}}};
  Table table{{{""}, {"samples", true}, {"window"}, {"rate [Hz]", true}, {"starts"}, {"amplitude [deg]", true}}};
  const std::size_t main = identification.MainFit();
  const std::vector<double>& amplitudes = identification.across[main].amplitudes;
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    const DataSummary& data = identification.recordings[k].data;
    const bool again = IsOneOfSeveral(identification, k);
    const std::string number = std::to_string(k + 1);
    const bool held = identification.FitOf(k, main).start == StartKind::kRelease;
    files.rows.push_back({number, FileText(data, again)});
    table.rows.push_back({number, std::to_string(data.used_samples) + " of " + std::to_string(data.samples),
                          WindowText(data.from, data.to), NumberText(data.sample_rate(), 4),
                          held ? "held" : "in motion",
                          std::isfinite(amplitudes[k]) ? NumberText(amplitudes[k] * Degrees("rad")->factor, 3) : "-"});
  }
  Section section{"Recordings", "", {std::move(files), std::move(table)}};
  return section.AddText("Amplitudes are root mean squares over the motion.");
}

/// The rig as its user described it, in SI units.
Section RigSection(const Rig& rig) {
  Table table{{{"name"}, {"value", true}, {"± std dev", false, 1}, {"unit"}, {"std dev"}}};
  for (const RigKey& key : RigKeys()) {
    const auto found = rig.source.is_object() ? rig.source.find(key.name) : rig.source.end();
    if (found == rig.source.end()) continue;
    const double std_dev = StdDevOfEntry(key, *found);
    const QuantityNumbers numbers(ValueOfEntry(*found), std_dev > 0 ? std::optional(std_dev) : std::nullopt);
    table.rows.push_back({std::string(key.name), numbers.Value(), numbers.Error(), std::string(key.unit),
                          !HasStdDev(*found) ? "assumed"
                          : std_dev > 0      ? "stated"
                                             : "exact"});
  }
  return {"Rig", "", {std::move(table)}};
}

}  // namespace

Sections DataSections(const Identification& identification) {
  Sections sections;
  if (identification.is_joint()) sections.push_back(RecordingSection(identification));
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    const IdentifiedRecording& recording = identification.recordings[k];
    Sections own = {DataSection(recording.data)};
    std::ranges::move(SamplingSections(recording.sampling), std::back_inserter(own));
    std::ranges::move(OfRecording(identification, k, std::move(own)), std::back_inserter(sections));
  }
  if (identification.rig) sections.push_back(RigSection(*identification.rig));
  return sections;
}

Sections OfRecording(const Identification& identification, std::size_t k, Sections sections) {
  if (!identification.is_joint()) return sections;
  for (Section& section : sections) section.recording = static_cast<int>(k) + 1;
  return sections;
}

}  // namespace pendulum
