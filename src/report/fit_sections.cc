// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/report/agreement_section.h"
#include "pendulum/report/ambiguity_sections.h"
#include "pendulum/report/budget_sections.h"
#include "pendulum/report/comparison_text.h"
#include "pendulum/report/data_sections.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/suspicion_sections.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

constexpr double kMinCorrelation = 0.1;  // smaller ones are not listed

using Row = std::vector<std::string>;

bool IsConverged(const FitReport& fit) { return fit.termination == Termination::kConverged; }

/// The work of the solver. How accurate the trajectories are is a matter of each recording.
std::string SolverText(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  std::string text = std::to_string(fit.solver.iterations) + " iterations, " + std::to_string(fit.solver.evaluations) +
                     " trajectories";
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    const FitReport& own = identification.FitOf(k, index);
    text += (k == 0 ? ", accurate to " : ", ") + NumberText(own.trace_error, 1) + " " + own.reading_unit;
  }
  return text;
}

Section ModelSection(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  Facts facts = {{"model", std::string(fit.model.name) + ":  " + WithUnbrokenTerms(SymbolicEquation(fit.model))}};
  if (identification.is_joint()) {
    facts.push_back({"shared", NameList(identification.across[index].shared) + ", by " +
                                   std::to_string(identification.recordings.size()) +
                                   " recordings; each recording has its own start, zero and noise"});
  } else {
    facts.push_back({"start", fit.start == StartKind::kRelease ? "held at an angle, then released"
                                                               : "in motion at the first used sample"});
  }
  facts.push_back({"status", std::string(TerminationName(fit.termination)) + ": " + Printable(fit.reason),
                   IsConverged(fit) ? Emphasis::kNone : Emphasis::kAlarm});
  if (fit.termination != Termination::kFailed) facts.push_back({"solver", SolverText(identification, index)});
  return {"Fit", "", {std::move(facts)}};
}

// --- parameters ------------------------------------------------------------------------------------------------------

/// Text shown instead of a standard error.
std::string Note(const ParameterEstimate& parameter) {
  if (parameter.fixed) return "(fixed)";
  return parameter.at_bound ? "(at bound)" : "";
}

/// A parameter in closed form: from all turning points if the check has it, otherwise the start value of the fit.
std::optional<double> InClosedForm(const ParameterEstimate& parameter, const ClosedFormCheck* check) {
  if (check == nullptr) return parameter.closed_form;
  const std::string quantity = std::string(parameter.info.name) + "_turning_points";
  const auto row = std::ranges::find(check->rows, quantity, &ClosedFormRow::quantity);
  return row == check->rows.end() ? parameter.closed_form : row->closed_form;
}

bool HasSystematic(const FitReport& fit) {
  return std::ranges::any_of(fit.parameters,
                             [](const ParameterEstimate& parameter) { return parameter.systematic.Total() > 0; });
}

/// The head of a column of total errors.
std::string ErrorHead(bool has_systematic) { return has_systematic ? "± total error" : "± std error"; }

/// A parameter in one unit: name, value, total error or note, unit, total interval.
Row ParameterRow(const ParameterEstimate& parameter, const Conversion& conversion, bool is_first) {
  const auto total = TotalStdError(parameter.std_error, parameter.systematic);
  const QuantityNumbers numbers(parameter.estimate, total, conversion.factor);
  const std::string note = is_first ? Note(parameter) : "";
  const std::string error = numbers.Error();
  const auto [lower, upper] = TotalInterval95(parameter);
  return {is_first ? std::string(parameter.info.name) : "", numbers.Value(),
          error + (error.empty() || note.empty() ? "" : " ") + note, std::string(conversion.unit),
          numbers.Interval(lower, upper)};
}

/// Errors and intervals of noise alone, where there are others, and closed forms, in the first unit of each parameter.
Table FurtherTable(const FitReport& fit, const ClosedFormCheck* check) {
  Table table{{{"name"}, {"symbol"}, {"± by noise"}, {"interval by noise"}, {"closed form", true}}};
  for (const ParameterEstimate& parameter : fit.parameters) {
    const QuantityNumbers numbers(parameter.estimate, parameter.std_error);
    const bool has_other = parameter.systematic.Total() > 0;
    const std::optional<double> closed_form = InClosedForm(parameter, check);
    table.rows.push_back({std::string(parameter.info.name), std::string(parameter.info.symbol),
                          has_other ? numbers.SecondError(parameter.std_error) : "",
                          has_other ? numbers.Interval(parameter.lower95, parameter.upper95) : "",
                          closed_form ? numbers.Number(*closed_form) : ""});
  }
  return table;
}

/// Explains missing standard errors; each reason occurs once.
void ExplainMissingErrors(const FitReport& fit, Section& section) {
  std::vector<std::pair<std::string, std::string>> names_by_reason;
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (parameter.std_error || parameter.fixed || parameter.reason.empty()) continue;
    const auto known = std::find_if(names_by_reason.begin(), names_by_reason.end(),
                                    [&](const auto& entry) { return entry.first == parameter.reason; });
    if (known == names_by_reason.end()) {
      names_by_reason.emplace_back(parameter.reason, parameter.info.name);
    } else {
      known->second.append(", ").append(parameter.info.name);
    }
  }
  for (const auto& [reason, names] : names_by_reason) {
    section.AddText(std::string("No standard error of ").append(names).append(": ").append(reason).append("."));
  }
}

std::string OpenIntervals(const FitReport& fit) {
  std::string text;
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (parameter.open_interval == OpenInterval::kClosed) continue;
    text += " The interval of " + std::string(parameter.info.name) +
            " is open: " + std::string(Sentence(parameter.open_interval)) + ".";
  }
  return text;
}

/// Names parameters that the recording hardly determines, and recordings that would.
void DescribeIdentifiability(const FitReport& fit, Section& section) {
  for (const Identifiability& known : fit.identifiability) {
    if (known.verdict == Identifiability::Verdict::kIdentifiable) continue;
    std::string compensation;
    for (const std::string& name : known.direction) {
      if (name == known.parameter) continue;
      compensation += (compensation.empty() ? " (its effect can be compensated by " : ", ") + name;
    }
    if (!compensation.empty()) compensation += ")";
    section.AddText(known.parameter + " is " + std::string(VerdictName(known.verdict)) + compensation + ": " +
                    known.advice + ".");
  }
}

/// Compares the rig file's own moment of inertia with the fitted one, if no check does.
std::string InertiaText(const FitReport& fit, const std::optional<Rig>& rig) {
  const ParameterEstimate* fitted = fit.Find("inertia");
  if (!rig || !rig->inertia || fitted == nullptr) return "";
  const double from_rig = rig->inertia->value;
  const double percent = 100 * (fitted->estimate / from_rig - 1);
  return "The rig file gives I_O = " + PlusMinusText(from_rig, rig->inertia->std_dev) + " kg m^2; the fitted I_O is " +
         NumberText(std::abs(percent), 2) + " % " + (percent < 0 ? "smaller" : "larger") + ".";
}

Table EstimateTable(const FitReport& fit) {
  Table table{{{"name"}, {"value", true}, {ErrorHead(HasSystematic(fit)), false, 1}, {"unit"}, {"95 % interval"}}};
  for (const ParameterEstimate& parameter : fit.parameters) {
    table.rows.push_back(ParameterRow(parameter, {parameter.unit}, true));
    if (const auto degrees = Degrees(parameter.unit)) table.rows.push_back(ParameterRow(parameter, *degrees, false));
  }
  return table;
}

constexpr const char* kNoEstimates = "These values are not estimates, because nothing was fitted.";

// --- derived quantities ----------------------------------------------------------------------------------------------

/// A derived quantity with its total error and interval, and the error by noise alone if there are others. An error
/// larger than the value carries no information: it belongs to a quotient whose divisor may be 0.
Row DerivedRow(const DerivedQuantity& quantity) {
  const std::optional<double> total = TotalStdError(quantity.std_error, quantity.systematic);
  const bool nothing = total.value_or(0) >= std::abs(quantity.estimate);
  const auto [lower, upper] = TotalInterval95(quantity);
  const auto number = [&](const std::optional<double>& end) -> std::string {
    if (!end) return "?";
    if (!(total > 0) || nothing) return NumberText(*end, kDigitsWithoutError);
    return RoundedText(*end, PdgRounding(quantity.estimate, *total));
  };
  ValueAndError text{NumberText(quantity.estimate, nothing ? kDigitsWithoutError : kTextDigits), ""};
  if (total > 0 && !nothing) text = PdgText(quantity.estimate, *total);
  const bool has_other = quantity.std_error && quantity.systematic.Total() > 0;
  return {quantity.name,
          text.value,
          text.error.empty() ? "" : "± " + text.error,
          quantity.unit,
          lower || upper ? "[" + number(lower) + ", " + number(upper) + "]" : "",
          has_other ? "± " + NumberText(*quantity.std_error, 2) + " by noise" : ""};
}

/// σ in other units: "(0.0512 deg, 0.26 resolutions)".
std::string OtherUnitsText(const NoiseEstimate& noise, const std::string& unit) {
  constexpr int kReadingDigits = 3;
  std::string also;
  if (const auto degrees = Degrees(unit)) {
    also = NumberText(noise.sigma * degrees->factor, kReadingDigits) + " " + std::string(degrees->unit);
  }
  if (noise.family == NoiseFamily::kAveraged) {
    also += (also.empty() ? "" : ", ") + NumberText(noise.sigma / noise.averaging.count, kReadingDigits) + " counts";
  } else if (noise.resolution > 0) {
    also += (also.empty() ? "" : ", ") + NumberText(noise.sigma / noise.resolution, kReadingDigits) + " resolutions";
  }
  return also.empty() ? "" : " (" + also + ")";
}

Section AllOfParameters(const FitReport& fit, const std::optional<Rig>& rig, const ClosedFormCheck* check) {
  Section section{"Parameters"};
  if (fit.termination == Termination::kFailed) section.AddText(kNoEstimates, Emphasis::kAlarm);
  section.Add(EstimateTable(fit)).Add(FurtherTable(fit, check));
  ExplainMissingErrors(fit, section);
  if (!fit.std_error_method.empty()) section.AddText("Standard errors: " + fit.std_error_method + ".");
  if (!fit.interval_method.empty()) section.AddText("Intervals: " + fit.interval_method + "." + OpenIntervals(fit));
  if (HasSystematic(fit))
    section.AddText("These are of noise alone; the total errors and intervals contain the whole error budget.");
  DescribeIdentifiability(fit, section);
  return section.AddText(check != nullptr ? "" : InertiaText(fit, rig));
}

Section DerivedSection(const FitReport& fit) {
  Table table{{{""}, {"", true}, {"", false, 1}, {""}, {""}, {""}}};
  for (const DerivedQuantity& quantity : fit.derived) table.rows.push_back(DerivedRow(quantity));
  return {"Derived quantities", "", {std::move(table)}};
}

Section CorrelationSection(const FitReport& fit) {
  std::vector<std::pair<double, std::string>> pairs;
  const auto size = static_cast<Eigen::Index>(fit.covariance_names.size());
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = i + 1; j < size; ++j) {
      const double correlation = Correlation(fit, i, j);
      if (!(std::abs(correlation) >= kMinCorrelation)) continue;
      pairs.emplace_back(correlation, fit.covariance_names[i] + ", " + fit.covariance_names[j]);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  Table table{{{""}, {"", true}}};
  for (const auto& [correlation, names] : pairs) table.rows.push_back({names, FixedText(correlation, 3)});
  return {"Correlations", "those below 0.1 in size are not listed", {std::move(table)}};
}

std::string NoiseText(const FitReport& fit) {
  const NoiseEstimate& noise = fit.noise;
  std::string text(NoiseFamilyName(noise.family));
  text += noise.family == NoiseFamily::kStudent ? "'s t, 4 degrees of freedom, scale " : ", sigma ";
  const ValueAndError sigma = PdgText(noise.sigma, noise.sigma_std_error.value_or(0));
  text +=
      noise.sigma_std_error && !sigma.error.empty() ? sigma.value + " ± " + sigma.error : NumberText(noise.sigma, 3);
  text += " " + fit.reading_unit + OtherUnitsText(noise, fit.reading_unit);
  if (noise.family == NoiseFamily::kAveraged)
    return text + " of one of the " + std::to_string(noise.averaging.readings) + " readings in a mean";
  if (noise.family != NoiseFamily::kEdges) return text;
  text += " of an edge";
  if (noise.stamp_ratio == 0) return text;
  return text + ", " + NumberText(1e6 * noise.stamp_ratio * noise.sigma, 2) + " us of its stamp";
}

constexpr std::string_view kSpringInSi =
    "th in rad from rest, torques in N m. The factor of th is the stiffness k of a spring or wire; for a pendulum at "
    "small angles it is the gravity torque G.";
constexpr std::string_view kSpringRelative =
    "th in rad from rest; torques are in units of the stiffness k of the spring or wire (for a pendulum at small "
    "angles, "
    "of the gravity torque G), because a free swing determines only ratios. To get SI units, measure the stiffness or "
    "know the moment of inertia, and give --rig with \"stiffness\" or \"inertia\".";

Section EquationSection(const FitReport& fit, const std::optional<Rig>& rig) {
  Section section{"Equation of motion", "", {Formula{WithUnbrokenTerms(FittedEquation(fit, rig))}}};
  if (fit.model.gravity.is_linear()) return section.AddText(std::string(rig ? kSpringInSi : kSpringRelative));
  if (rig) return section.AddText("th in rad from hanging straight down, torques in N m.");
  return section.AddText(
      "th in rad from hanging straight down; torques are in units of the gravity torque G, because a free swing "
      "determines only ratios. To get SI units, measure the mass, the distance from the pivot to the centre of mass "
      "and g, or weigh the pendulum held horizontally at a known distance from the pivot, and give --rig.");
}

Section StatisticsSection(const Identification& identification, std::size_t index, std::size_t k) {
  const FitReport& fit = identification.FitOf(k, index);
  const FitStatistics& statistics = fit.statistics;
  Facts facts = {
      {"noise", NoiseText(fit)},
      {"because", fit.noise.why},
      {"rms residual", ReadingText(statistics.rms_residual, fit.reading_unit)},
      {"lag-1 correlation", FixedText(fit.noise.lag1_correlation, 3)},
      {"Durbin-Watson", FixedText(statistics.durbin_watson, 3)},
      {"Ljung-Box, runs", "p " + NumberText(statistics.ljung_box_p, 2) + ", " + NumberText(statistics.runs_p, 2)},
      {"autocorrelation", fit.noise.autocorrelation.Name() + "; for estimating a constant, equivalent to " +
                              NumberText(std::round(statistics.effective_samples)) + " independent samples"},
      {"log-likelihood", FixedText(statistics.log_likelihood, 2)},
      {"AIC, AICc, BIC",
       FixedText(statistics.aic, 2) + ", " + FixedText(statistics.aicc, 2) + ", " + FixedText(statistics.bic, 2)}};
  if (fit.HasWarning("lack_of_fit"))
    facts.push_back({"lack of fit", "the residuals are more than noise", Emphasis::kCaution});
  if (identification.is_joint()) facts.push_back({"separate fit", identification.across[index].separate[k]});
  return {"Noise and statistics", "", {std::move(facts)}};
}

/// The criteria of all recordings together.
Section SumSection(const FitStatistics& all) {
  return {"Noise and statistics: all recordings",
          "",
          {Facts{{"log-likelihood", FixedText(all.log_likelihood, 2)},
                 {"AIC, AICc, BIC",
                  FixedText(all.aic, 2) + ", " + FixedText(all.aicc, 2) + ", " + FixedText(all.bic, 2)}}}};
}

/// What each of several recordings does not share.
Section OwnSection(const Identification& identification, std::size_t index) {
  const bool has_systematic = HasSystematic(identification.fits[index]);
  Table table{{{""}, {"name"}, {"value", true}, {ErrorHead(has_systematic), false, 1}, {"unit"}, {"95 % interval"}}};
  const std::vector<std::string>& shared = identification.across[index].shared;
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    std::string number = std::to_string(k + 1);
    for (const ParameterEstimate& parameter : identification.FitOf(k, index).parameters) {
      if (std::ranges::find(shared, parameter.info.name) != shared.end()) continue;
      const auto add = [&](Row row) {
        row.insert(row.begin(), std::exchange(number, ""));
        table.rows.push_back(std::move(row));
      };
      add(ParameterRow(parameter, {parameter.unit}, true));
      if (const auto degrees = Degrees(parameter.unit)) add(ParameterRow(parameter, *degrees, false));
    }
  }
  return {"Each recording's own", "by the joint fit", {std::move(table)}};
}

/// What the fit says of recording k alone. Of several recordings it is the separate fit that is checked.
Sections OwnSections(const Identification& identification, std::size_t index, std::size_t k) {
  const IdentifiedRecording& recording = identification.recordings[k];
  const FitReport& fit = identification.FitOf(k, index);
  Sections sections = ConstancySections(recording.ConstancyOf(index));
  std::ranges::move(SuspicionSections(fit), std::back_inserter(sections));
  for (Section& section : sections) section.remark = identification.is_joint() ? "of the separate fit" : "";
  return OfRecording(identification, k, std::move(sections));
}

void AddStatistics(const Identification& identification, std::size_t index, Sections& sections) {
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    std::ranges::move(OfRecording(identification, k, {StatisticsSection(identification, index, k)}),
                      std::back_inserter(sections));
  }
  if (identification.is_joint()) sections.push_back(SumSection(identification.fits[index].statistics));
}

}  // namespace

std::string WithUnbrokenTerms(const std::string& equation) {
  std::string text;
  const auto is_sign = [&](std::size_t i) {
    return i < equation.size() && std::string_view("+-=").find(equation[i]) < 3;
  };
  for (std::size_t i = 0; i < equation.size(); ++i) {
    if (equation[i] == ' ' && !is_sign(i + 1)) {
      text += kNoBreak;
    } else {
      text += equation[i];
    }
  }
  return text;
}

Section ParameterSection(const FitReport& fit, bool is_one_of_several) {
  Section section{"Parameters"};
  if (is_one_of_several) section.law = fit.model.name;
  if (!IsConverged(fit)) {
    section.AddText(std::string(TerminationName(fit.termination)) + ": " + fit.reason + ".", Emphasis::kAlarm);
  }
  if (fit.termination == Termination::kFailed) section.AddText(kNoEstimates, Emphasis::kAlarm);
  return section.Add(EstimateTable(fit));
}

Sections FitSections(const Identification& identification, std::size_t index) {
  const FitReport& fit = identification.fits[index];
  const std::optional<Rig>& rig = identification.si_rig();
  const bool is_joint = identification.is_joint();
  const ClosedFormCheck* const check = is_joint ? nullptr : identification.recordings.front().CheckOf(index);
  Sections sections = {ModelSection(identification, index), AllOfParameters(fit, rig, check)};
  if (const std::optional<Homogeneity>& homogeneity = identification.across[index].homogeneity) {
    if (IsConverged(fit) && !homogeneity->agrees()) {
      sections.back().AddText("The recordings do not agree, but these errors assume that they do: see below.",
                              Emphasis::kCaution);
    }
    sections.push_back(AgreementSection(identification, index));
  }
  std::ranges::move(BudgetSections(fit), std::back_inserter(sections));
  // If the fit to several recordings did not converge, its motion describes none of them.
  const bool is_failed = fit.termination == Termination::kFailed;
  const bool is_a_motion = !is_failed && !(is_joint && fit.termination == Termination::kNotConverged);
  if (is_joint && is_a_motion) sections.push_back(OwnSection(identification, index));
  if (!fit.derived.empty() && (!is_joint || is_a_motion)) sections.push_back(DerivedSection(fit));
  if (fit.covariance_names.size() > 1) sections.push_back(CorrelationSection(fit));
  if (!is_failed) AddStatistics(identification, index, sections);
  if (is_a_motion && identification.SharesMotion(index)) sections.push_back(EquationSection(fit, rig));
  for (std::size_t k = 0; k < identification.recordings.size(); ++k) {
    std::ranges::move(OwnSections(identification, index, k), std::back_inserter(sections));
  }
  std::ranges::move(AmbiguitySections(identification, index), std::back_inserter(sections));
  return sections;
}

}  // namespace pendulum
