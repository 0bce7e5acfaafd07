// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/report/closed_form_text.h"
#include "pendulum/report/equation.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/rounding.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

constexpr double kLeastCorrelation = 0.1;  // smaller ones are not listed

using Row = std::vector<std::string>;

/// The free swings of the recording, the one that was fitted marked.
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

std::string DataText(const DataSummary& data) {
  std::vector<Row> rows;
  if (!data.path.empty()) rows.push_back({"file", data.path});
  rows.push_back({"samples", std::to_string(data.used_samples) + " used of " + std::to_string(data.samples)});
  rows.push_back({"window", NumberText(data.from, kTextDigits) + " s to " + NumberText(data.to, kTextDigits) + " s, " +
                                NumberText(data.sample_rate(), kTextDigits) + " Hz on average"});
  if (!data.begins.empty()) {
    rows.push_back({"begins", data.begins});
    rows.push_back({"ends", data.ends});
  }
  if (data.clock_scale != 1 || data.clock_scale_std_dev > 0) {
    const ValueAndError scale = PdgText(data.clock_scale, data.clock_scale_std_dev);
    rows.push_back({"clock", scale.value + (scale.error.empty() ? "" : " ± " + scale.error) +
                                 " true seconds to its second; parameters are in true seconds"});
  }
  if (data.releases.size() > 1) rows.push_back({"releases", ReleasesText(data)});
  if (data.resolution > 0) rows.push_back({"resolution", ReadingText(data.resolution, data.unit) + SourceText(data)});
  return Heading("Data") + Facts(rows);
}

std::string ModelText(const FitReport& fit) {
  const std::string start =
      fit.start == StartKind::kRelease ? "held at an angle, then released" : "in motion at the first used sample";
  return Heading("Fit") +
         Facts({{"model", std::string(fit.model.name) + ":  " + SymbolicEquation(fit.model)}, {"start", start}}) +
         Paragraph(std::string(TerminationName(fit.termination)) + ": " + fit.reason, "    status  ", kTextWidth);
}

// --- parameters ------------------------------------------------------------------------------------------------------

std::vector<Column> ParameterColumns() {
  return {{"name"}, {"symbol"},        {"value", true},  {"± std error", false, 1},
          {"unit"}, {"95 % interval"}, {"± systematic"}, {"closed form"},
          {""}};
}

std::string Note(const ParameterEstimate& parameter) {
  if (parameter.fixed) return "fixed";
  return parameter.at_bound ? "at its bound" : "";
}

/// A parameter in closed form: from all turning points where the check has it, else where the fit began.
std::optional<double> InClosedForm(const ParameterEstimate& parameter, const ClosedFormCheck* check) {
  if (check == nullptr) return parameter.closed_form;
  const std::string quantity = std::string(parameter.info.name) + "_turning_points";
  const auto row = std::ranges::find(check->rows, quantity, &ClosedFormRow::quantity);
  return row == check->rows.end() ? parameter.closed_form : row->closed_form;
}

Row ParameterRow(const ParameterEstimate& parameter, const std::optional<double>& closed_form,
                 const Conversion& conversion) {
  const QuantityNumbers numbers(parameter.estimate, parameter.std_error, conversion.factor);
  return {"",
          "",
          numbers.Value(),
          numbers.Error(),
          std::string(conversion.unit),
          numbers.Interval(parameter.lower95, parameter.upper95),
          numbers.SecondError(parameter.systematic_std_error),
          closed_form ? numbers.Number(*closed_form) : "",
          ""};
}

/// Why parameters have no standard error, each reason said once.
std::string MissingErrors(const FitReport& fit) {
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
  std::string text;
  for (const auto& [reason, names] : names_by_reason) {
    text += Prose(std::string("No standard error of ").append(names).append(": ").append(reason).append("."));
  }
  return text;
}

std::string OpenIntervals(const FitReport& fit) {
  std::string text;
  for (const ParameterEstimate& parameter : fit.parameters) {
    if (parameter.open_interval.empty()) continue;
    text += " That of " + std::string(parameter.info.name) + " is open: " + parameter.open_interval + ".";
  }
  return text;
}

/// What the recording hardly tells, and what would.
std::string IdentifiabilityText(const FitReport& fit) {
  std::string text;
  for (const Identifiability& known : fit.identifiability) {
    if (known.verdict == Identifiability::Verdict::kIdentifiable) continue;
    std::string traded;
    for (const std::string& name : known.direction) {
      if (name != known.parameter) traded += (traded.empty() ? " (traded for " : ", ") + name;
    }
    if (!traded.empty()) traded += ")";
    text +=
        Prose(known.parameter + " is " + std::string(VerdictName(known.verdict)) + traded + ": " + known.advice + ".");
  }
  return text;
}

/// The rig file's own moment of inertia beside the fitted one, where no check says it.
std::string InertiaText(const FitReport& fit, const std::optional<Rig>& rig) {
  const ParameterEstimate* fitted = fit.Find("inertia");
  if (!rig || !rig->inertia || fitted == nullptr) return "";
  const double from_rig = rig->inertia->value;
  const double percent = 100 * (fitted->estimate / from_rig - 1);
  const ValueAndError text = PdgText(from_rig, rig->inertia->std_dev);
  const std::string value =
      rig->inertia->std_dev > 0 ? text.value + " ± " + text.error : NumberText(from_rig, kTextDigits);
  return Prose("The rig file gives I_O = " + value + " kg m^2; the fitted I_O is " + NumberText(std::abs(percent), 2) +
               " % " + (percent < 0 ? "smaller" : "larger") + ".");
}

std::string ParametersText(const FitReport& fit, const std::optional<Rig>& rig, const ClosedFormCheck* check) {
  std::vector<Row> rows;
  for (const ParameterEstimate& parameter : fit.parameters) {
    const std::optional<double> closed_form = InClosedForm(parameter, check);
    Row row = ParameterRow(parameter, closed_form, {parameter.unit});
    row.front() = parameter.info.name;
    row[1] = parameter.info.symbol;
    row.back() = Note(parameter);
    rows.push_back(std::move(row));
    if (const auto degrees = Degrees(parameter.unit)) rows.push_back(ParameterRow(parameter, closed_form, *degrees));
  }
  const bool failed = fit.termination == Termination::kFailed;
  std::string text = Heading("Parameters") + (failed ? Prose("These are no estimates: nothing was fitted.") : "");
  text += AlignedTable(ParameterColumns(), rows, kTextIndent) + MissingErrors(fit);
  if (!fit.std_error_method.empty()) text += Prose("Standard errors: " + fit.std_error_method + ".");
  if (!fit.interval_method.empty()) text += Prose("Intervals: " + fit.interval_method + "." + OpenIntervals(fit));
  return text + IdentifiabilityText(fit) + (check != nullptr ? "" : InertiaText(fit, rig));
}

// --- what follows from the parameters -----------------------------------------------------------------------------

/// An error beyond the value, of a quotient whose divisor may be 0, says nothing.
bool SaysNothing(const DerivedQuantity& quantity) {
  return quantity.std_error.value_or(0) >= std::abs(quantity.estimate);
}

std::string DerivedInterval(const DerivedQuantity& quantity) {
  if (!quantity.lower95 && !quantity.upper95) return "";
  const auto number = [&](const std::optional<double>& end) -> std::string {
    if (!end) return "?";
    const double error = quantity.std_error.value_or(0);
    if (!(error > 0) || SaysNothing(quantity)) return NumberText(*end, kDigitsWithoutError);
    return RoundedText(*end, PdgRounding(quantity.estimate, error));
  };
  return "[" + number(quantity.lower95) + ", " + number(quantity.upper95) + "]";
}

std::string DerivedText(const FitReport& fit) {
  std::vector<Row> rows;
  for (const DerivedQuantity& quantity : fit.derived) {
    const bool nothing = SaysNothing(quantity);
    ValueAndError text{NumberText(quantity.estimate, nothing ? kDigitsWithoutError : kTextDigits), ""};
    if (quantity.std_error.value_or(0) > 0 && !nothing) text = PdgText(quantity.estimate, *quantity.std_error);
    rows.push_back({quantity.name, text.value, text.error.empty() ? "" : "± " + text.error, quantity.unit,
                    DerivedInterval(quantity)});
  }
  if (rows.empty()) return "";
  return Heading("Derived quantities") +
         AlignedTable({{""}, {"", true}, {"", false, 1}, {""}, {""}}, rows, kTextIndent);
}

std::string CorrelationText(const FitReport& fit) {
  std::vector<std::pair<double, std::string>> pairs;
  const auto size = static_cast<Eigen::Index>(fit.covariance_names.size());
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = i + 1; j < size; ++j) {
      const double correlation = Correlation(fit, i, j);
      if (!(std::abs(correlation) >= kLeastCorrelation)) continue;
      pairs.emplace_back(correlation, fit.covariance_names[i] + ", " + fit.covariance_names[j]);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  if (size < 2) return "";
  std::vector<Row> rows;
  rows.reserve(pairs.size());
  for (const auto& [correlation, names] : pairs) rows.push_back({names, FixedText(correlation, 3)});
  return "[[Correlations]] (those below 0.1 in size are not listed)\n" +
         AlignedTable({{""}, {"", true}}, rows, kTextIndent);
}

/// In the other units that σ is thought of in: "(0.0512 deg, 0.26 resolutions)".
std::string AlsoText(const NoiseEstimate& noise, const std::string& unit) {
  constexpr int kReadingDigits = 3;
  std::string also;
  if (const auto degrees = Degrees(unit)) {
    also = NumberText(noise.sigma * degrees->factor, kReadingDigits) + " " + std::string(degrees->unit);
  }
  if (noise.resolution > 0) {
    also += (also.empty() ? "" : ", ") + NumberText(noise.sigma / noise.resolution, kReadingDigits) + " resolutions";
  }
  return also.empty() ? "" : " (" + also + ")";
}

std::string NoiseText(const FitReport& fit) {
  const NoiseEstimate& noise = fit.noise;
  std::string text(NoiseFamilyName(noise.family));
  text += noise.family == NoiseFamily::kStudent ? "'s t, 4 degrees of freedom, scale " : ", sigma ";
  const ValueAndError sigma = PdgText(noise.sigma, noise.sigma_std_error.value_or(0));
  text +=
      noise.sigma_std_error && !sigma.error.empty() ? sigma.value + " ± " + sigma.error : NumberText(noise.sigma, 3);
  return text + " " + fit.reading_unit + AlsoText(noise, fit.reading_unit);
}

std::string StatisticsText(const FitReport& fit) {
  if (fit.termination == Termination::kFailed) return "";
  const FitStatistics& statistics = fit.statistics;
  return Heading("Noise and statistics") +
         Facts({{"noise", NoiseText(fit)},
                {"because", fit.noise.why},
                {"rms residual", ReadingText(statistics.rms_residual, fit.reading_unit)},
                {"lag-1 correlation", FixedText(fit.noise.lag1_correlation, 3)},
                {"Durbin-Watson", FixedText(statistics.durbin_watson, 3)},
                {"Ljung-Box, runs",
                 "p " + NumberText(statistics.ljung_box_p, 2) + ", " + NumberText(statistics.runs_p, 2)},
                {"memory", fit.noise.memory.Name() + "; of a constant the samples tell as much as " +
                               NumberText(std::round(statistics.effective_samples)) + " independent ones"},
                {"log-likelihood", FixedText(statistics.log_likelihood, 2)},
                {"AIC, AICc, BIC", FixedText(statistics.aic, 2) + ", " + FixedText(statistics.aicc, 2) + ", " +
                                       FixedText(statistics.bic, 2)},
                {"solver", std::to_string(fit.solver.iterations) + " iterations, " +
                               std::to_string(fit.solver.evaluations) + " trajectories, accurate to " +
                               NumberText(fit.trace_error, 1) + " " + fit.reading_unit}});
}

std::string EquationSection(const FitReport& fit, const std::optional<Rig>& rig) {
  if (fit.termination == Termination::kFailed) return "";
  std::string text = Heading("Equation of motion") + std::string(kTextIndent, ' ') + FittedEquation(fit, rig) + "\n";
  if (rig) return text + Prose("th in rad from hanging straight down, torques in N m.");
  return text +
         Prose(
             "th in rad from hanging straight down; torques are in units of the gravity torque G, for a free swing "
             "tells only ratios. To get SI, measure the mass, the distance from the pivot to the centre of mass and g, "
             "or "
             "weigh the pendulum held horizontally at a known distance from the pivot, and give --rig.");
}

std::string FitText(const FitReport& fit, const std::optional<Rig>& rig, const ClosedFormCheck* check) {
  return ModelText(fit) + ParametersText(fit, rig, check) + DerivedText(fit) + CorrelationText(fit) +
         StatisticsText(fit) + EquationSection(fit, rig);
}

std::string WarningsText(const RunReport& report) {
  const std::vector<Warning> warnings = AllWarnings(report);
  std::string text = warnings.empty() ? "" : Heading("Warnings");
  for (const Warning& warning : warnings) text += Paragraph(warning.message, "  - ", kTextWidth);
  return text;
}

}  // namespace

std::string ToText(const RunReport& report) {
  std::string text = DataText(report.data) + SamplingText(report);
  for (std::size_t i = 0; i < report.fits.size(); ++i) {
    text += FitText(report.fits[i], report.rig, report.CheckOf(i));
  }
  return text + ClosedFormText(report) + WarningsText(report);
}

}  // namespace pendulum
