// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/agreement_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

constexpr const char* kWhatSeparateMeans =
    "Separate: the estimate from each recording on its own, without bounds and priors; its errors are wider where few "
    "of its samples are independent. z: its difference from the mean of the others, in standard errors. Recordings "
    "disagree below p 0.01, which happens by chance to recordings of one "
    "rig in 1 of 100 cases.";

/// A line of characters from `low` to `high` that shows intervals.
class Strip {
 public:
  Strip(double low, double high) : low_(low), high_(high) {}

  std::string Draw(double value, double reach, double mark) const {
    std::string line(kWidth, ' ');
    line[At(mark)] = '|';
    for (std::size_t i = At(value - reach); i <= At(value + reach); ++i) line[i] = '-';
    line[At(value)] = '*';
    const std::size_t last = line.find_last_not_of(' ');
    return line.substr(0, last + 1);
  }

 private:
  static constexpr std::size_t kWidth = 21;

  std::size_t At(double x) const {
    if (!(high_ > low_)) return kWidth / 2;
    const double place = std::clamp((x - low_) / (high_ - low_), 0.0, 1.0);
    return static_cast<std::size_t>(std::lround(place * (kWidth - 1)));
  }

  double low_, high_;
};

Strip StripOf(const SharedParameter& parameter) {
  const double reach = kNormal95 * parameter.scatter.std_error;
  double low = parameter.scatter.mean - reach, high = parameter.scatter.mean + reach;
  for (const RunEstimate& run : parameter.runs) {
    if (!run.value) continue;
    low = std::min(low, *run.value - kNormal95 * *run.std_error);
    high = std::max(high, *run.value + kNormal95 * *run.std_error);
  }
  return {low, high};
}

void AddRow(const std::string& name, double value, const std::optional<double>& error, const std::string& last,
            const std::string& strip, Table& table) {
  const QuantityNumbers numbers(value, error);
  // Prevents line breaks within the strip.
  std::string drawn;
  for (const char c : strip) drawn += c == ' ' ? std::string(kNoBreak) : std::string(1, c);
  table.rows.push_back({name, numbers.Value(), numbers.Error(), last, drawn});
}

/// A forest plot in characters: each separate recording, the joint estimate, the mean of random effects.
Table ForestTable(const SharedParameter& parameter, const FitReport& fit) {
  Table table{{{parameter.name + " [" + parameter.unit + "]"}, {"", true}, {"", false, 1}, {"z", true}, {""}}};
  const Strip strip = StripOf(parameter);
  const ParameterEstimate* const joint = fit.Find(parameter.name);
  const double mark = joint == nullptr ? parameter.scatter.mean : joint->estimate;
  for (std::size_t k = 0; k < parameter.runs.size(); ++k) {
    const RunEstimate& run = parameter.runs[k];
    const std::string name = std::to_string(k + 1) + " separate";
    if (!run.value) {
      table.rows.push_back({name, "-", "", "", ""});
      continue;
    }
    AddRow(name, *run.value, run.std_error, run.z ? FixedText(*run.z, 1) : "",
           strip.Draw(*run.value, kNormal95 * *run.std_error, mark), table);
  }
  if (joint != nullptr) {
    AddRow("joint", joint->estimate, joint->std_error, "",
           strip.Draw(joint->estimate, kNormal95 * joint->std_error.value_or(0), mark), table);
  }
  const RandomEffects& scatter = parameter.scatter;
  AddRow("random effects", scatter.mean, scatter.std_error, "",
         strip.Draw(scatter.mean, kNormal95 * scatter.std_error, mark), table);
  return table;
}

std::string ScatterText(const SharedParameter& parameter) {
  const RandomEffects& scatter = parameter.scatter;
  const QuantityNumbers mean(scatter.mean, scatter.std_error);
  const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
  return "Agreement: chi-square " + NumberText(parameter.statistic, 3) + ", " + DegreesOfFreedomText(parameter.dof) +
         ", p " + ProbabilityText(parameter.p) + ". Random effects: mean in " +
         mean.Interval(scatter.lower95, scatter.upper95) + " (95 %); between recordings a standard deviation of " +
         NumberText(scatter.between, 2) + unit + ", in [" + NumberText(scatter.between_lower95, 2) + ", " +
         (std::isfinite(scatter.between_upper95) ? NumberText(scatter.between_upper95, 2) : "?") + "].";
}

/// Whether parameters change with the amplitude of the recordings.
void AddAmplitudes(const std::vector<AmplitudeDependence>& all, Section& section) {
  if (all.empty()) return;
  Table table{{{"by amplitude²"}, {"slope", true}, {"± error", false, 1}, {"unit"}, {"change", true}, {"p"}}};
  for (const AmplitudeDependence& one : all) {
    const QuantityNumbers slope(one.slope, one.slope_std_error);
    table.rows.push_back({one.name, slope.Value(), slope.Error(), one.unit + " / rad^2",
                          NumberText(100 * one.span, 2) + " %", ProbabilityText(one.p)});
  }
  section.Add(std::move(table));
}

}  // namespace

Section AgreementSection(const Identification& identification, std::size_t fit) {
  const Homogeneity& homogeneity = *identification.across[fit].homogeneity;
  Section section{"Do the recordings agree?"};
  section.AddText("Verdict: " + Printable(homogeneity.verdict) + ".",
                  homogeneity.matters ? Emphasis::kCaution : Emphasis::kNone);
  for (const SharedParameter& parameter : homogeneity.parameters) {
    section.Add(ForestTable(parameter, identification.fits[fit])).AddText(ScatterText(parameter));
  }
  if (!homogeneity.parameters.empty()) section.AddText(kWhatSeparateMeans);
  AddAmplitudes(homogeneity.amplitude_dependence, section);
  return section;
}

}  // namespace pendulum
