// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/joint_sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"
#include "pendulum/report/ambiguity_sections.h"
#include "pendulum/report/comparison_text.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/fit_sections.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

// ---- The recordings -------------------------------------------------------------------------------------------------

std::string WindowText(const DataSummary& data) {
  return NumberText(data.from, 4) + " to " + NumberText(data.to, 4) + " s";
}

std::string FileText(const DataSummary& data, bool several_releases) {
  const std::string path = data.path.empty() ? "-" : Printable(data.path);
  return several_releases && data.release > 0 ? path + ", swing " + std::to_string(data.release) : path;
}

Section RecordingSection(const Identification& identification) {
  Table files{{{""}, {"file"}}};
  Table table{{{""}, {"samples", true}, {"window"}, {"rate [Hz]", true}, {"starts"}, {"amplitude [deg]", true}}};
  const std::vector<double>& amplitudes = identification.joint[identification.MainFit()].homogeneity.amplitudes;
  for (std::size_t k = 0; k < identification.runs.size(); ++k) {
    const DataSummary& data = identification.runs[k].data;
    const bool again = IsOneOfSeveral(identification, k);
    const std::string number = std::to_string(k + 1);
    const bool held = identification.runs[k].fits.front().start == StartKind::kRelease;
    files.rows.push_back({number, FileText(data, again)});
    table.rows.push_back({number, std::to_string(data.used_samples) + " of " + std::to_string(data.samples),
                          WindowText(data), NumberText(data.sample_rate(), 4), held ? "held" : "in motion",
                          std::isfinite(amplitudes[k]) ? NumberText(amplitudes[k] * Degrees("rad")->factor, 3) : "-"});
  }
  Section section{"Recordings", "", {std::move(files), std::move(table)}};
  return section.AddText("Amplitudes are root mean squares over the motion.");
}

Section FitSection(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  const bool converged = fit.termination == Termination::kConverged;
  const std::string count = std::to_string(identification.runs.size());
  return {"Fit",
          "",
          {Facts{{"model", std::string(fit.model.name) + ":  " + WithUnbrokenTerms(SymbolicEquation(fit.model))},
                 {"shared", NameList(identification.joint[index].shared) + ", by " + count +
                                " recordings; each recording has its own start, zero and noise"},
                 {"status", std::string(TerminationName(fit.termination)) + ": " + Printable(fit.reason),
                  converged ? Emphasis::kNone : Emphasis::kAlarm}}}};
}

// ---- Agreement ------------------------------------------------------------------------------------------------------

constexpr const char* kWhatAloneIs =
    "Separate: the estimate from each recording on its own, without bounds and priors; its errors are wider where few "
    "of its samples are independent. Recordings disagree below p 0.01, which happens by chance to recordings of one "
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

// ---- Separate parameters of each recording --------------------------------------------------------------------------

bool IsShared(const Identification& identification, std::size_t index, std::string_view name) {
  const std::vector<std::string>& shared = identification.joint[index].shared;
  return std::ranges::find(shared, name) != shared.end();
}

Section OwnSection(const Identification& identification, std::size_t index) {
  Table table{{{""}, {"name"}, {"value", true}, {"± std error", false, 1}, {"unit"}, {"95 % interval"}}};
  for (std::size_t k = 0; k < identification.runs.size(); ++k) {
    std::string number = std::to_string(k + 1);
    for (const ParameterEstimate& parameter : identification.runs[k].fits[index].parameters) {
      if (IsShared(identification, index, parameter.info.name)) continue;
      const QuantityNumbers numbers(parameter.estimate, parameter.std_error);
      const std::string note = parameter.fixed ? "(fixed)" : parameter.at_bound ? "(at bound)" : numbers.Error();
      table.rows.push_back({std::exchange(number, ""), std::string(parameter.info.name), numbers.Value(), note,
                            parameter.unit, numbers.Interval(parameter.lower95, parameter.upper95)});
    }
  }
  return {"Each recording's own", "by the joint fit", {std::move(table)}};
}

Section NoiseSection(const Identification& identification, std::size_t index) {
  Facts facts;
  for (std::size_t k = 0; k < identification.runs.size(); ++k) {
    const FitReport& fit = identification.runs[k].fits[index];
    if (fit.termination == Termination::kFailed) continue;
    const bool lacks = fit.HasWarning("lack_of_fit");
    facts.push_back({"recording " + std::to_string(k + 1),
                     NoiseText(fit) + "; rms residual " + ReadingText(fit.statistics.rms_residual, fit.reading_unit) +
                         ", lag-1 correlation " + FixedText(fit.noise.lag1_correlation, 3) + ", " +
                         fit.noise.autocorrelation.Name() + (lacks ? "; lack of fit" : "") +
                         "; separate fit: " + identification.joint[index].alone[k],
                     lacks ? Emphasis::kCaution : Emphasis::kNone});
  }
  const FitStatistics& all = identification.fits[index].statistics;
  facts.push_back({"all", "log-likelihood " + FixedText(all.log_likelihood, 2) + ", AIC " + FixedText(all.aic, 2) +
                              ", AICc " + FixedText(all.aicc, 2) + ", BIC " + FixedText(all.bic, 2)});
  return {"Noise and statistics", "", {std::move(facts)}};
}

void AddMainFit(const Identification& identification, std::size_t index, Sections& sections) {
  const FitReport& fit = identification.fits[index];
  sections.push_back(FitSection(identification, index));
  sections.push_back(AllOfParameters(fit, identification.si_rig(), nullptr));
  if (fit.termination == Termination::kConverged && !identification.joint[index].homogeneity.agrees()) {
    sections.back().AddText("The recordings do not agree, but these errors assume that they do: see below.",
                            Emphasis::kCaution);
  }
  sections.push_back(AgreementSection(identification, index));
  if (fit.termination == Termination::kFailed) return;
  // If the joint fit did not converge, its motion describes none of the recordings.
  const bool is_a_motion = fit.termination != Termination::kNotConverged;
  if (is_a_motion) sections.push_back(OwnSection(identification, index));
  if (is_a_motion && !fit.derived.empty()) sections.push_back(DerivedSection(fit));
  if (fit.covariance_names.size() > 1) sections.push_back(CorrelationSection(fit));
  sections.push_back(NoiseSection(identification, index));
  const bool whole = identification.joint[index].shared.size() == PhysicalParameters(fit.model).size();
  if (is_a_motion && whole) sections.push_back(EquationSection(fit, identification.si_rig()));
  std::ranges::move(AmbiguitySections(identification, index), std::back_inserter(sections));
}

}  // namespace

Section AgreementSection(const Identification& identification, std::size_t fit) {
  const Homogeneity& homogeneity = identification.joint[fit].homogeneity;
  Section section{"Do the recordings agree?"};
  const bool agrees = homogeneity.agrees();
  section.AddText("Verdict: " + Printable(homogeneity.verdict) + ".", agrees ? Emphasis::kNone : Emphasis::kCaution);
  for (const SharedParameter& parameter : homogeneity.parameters) {
    section.Add(ForestTable(parameter, identification.fits[fit])).AddText(ScatterText(parameter));
  }
  if (!homogeneity.parameters.empty()) section.AddText(kWhatAloneIs);
  return section;
}

Sections JointSections(const Identification& identification) {
  Sections sections = {RecordingSection(identification)};
  std::ranges::move(ComparisonSections(identification), std::back_inserter(sections));
  for (std::size_t i = 0; i < identification.fits.size(); ++i) {
    if (identification.IsShownInFull(i)) AddMainFit(identification, i, sections);
  }
  for (std::size_t i = 0; i < identification.fits.size(); ++i) {
    if (!identification.IsShownInFull(i)) sections.push_back(ParameterSection(identification.fits[i], true));
  }
  return sections;
}

}  // namespace pendulum
