// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/closed_form_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/report/closed_form_quantities.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Cells = std::vector<std::string>;

// --- sampling --------------------------------------------------------------------------------------------------------

std::string JitterText(const Sampling& sampling) {
  constexpr double kEven = 1e-6;  // share of an interval: rounding of the time stamps
  if (sampling.jitter * sampling.rate_hz < kEven) return "even";
  return "intervals scatter by " + NumberText(1e3 * sampling.jitter, 2) + " ms";
}

std::string GapsText(const Sampling& sampling) {
  if (sampling.gaps == 0) return "none";
  return std::to_string(sampling.gaps) + ", of " + NumberText(sampling.longest_gap, 3) + " s at most";
}

std::string SwingText(const Sampling& sampling) {
  std::string text = NumberText(sampling.frequency_hz, 3) + " Hz: " + NumberText(sampling.samples_per_period, 3) +
                     " samples a period, Nyquist margin " + NumberText(sampling.nyquist_margin, 3);
  if (!sampling.expected_frequency_hz) return text;
  return text + "; " + NumberText(*sampling.expected_frequency_hz, 3) + " Hz expected from the rig";
}

std::string LevelsText(const Sampling& sampling) {
  return NumberText(sampling.start_counts) + " peak to peak at the start, " + NumberText(sampling.end_counts) +
         " at the end";
}

// --- closed forms ----------------------------------------------------------------------------------------------------

Cells EstimateCells(const ReportedEstimate& reported, const Conversion& conversion) {
  const QuantityNumbers numbers(reported.estimate.value, reported.estimate.std_error, conversion.factor);
  return {"", "", numbers.Value(), numbers.Error(), std::string(conversion.unit)};
}

/// `in_degrees`: adds a row in degrees below each value in radians.
Table EstimateTable(const std::vector<ReportedEstimate>& estimates, bool in_degrees) {
  std::vector<Cells> rows;
  for (const ReportedEstimate& reported : estimates) {
    Cells row = EstimateCells(reported, {reported.unit});
    row[0] = reported.name;
    row[1] = reported.symbol;
    rows.push_back(std::move(row));
    const auto degrees = Degrees(reported.unit);
    if (in_degrees && degrees) rows.push_back(EstimateCells(reported, *degrees));
  }
  return {{{"name"}, {"symbol"}, {"value", true}, {"± std error", false, 1}, {"unit"}}, std::move(rows)};
}

void AddLinear(const ClosedForms& forms, const std::optional<Rig>& rig, Section& section) {
  if (!forms.linear) {
    section.AddText("There is no log decrement, because no two successive turning points are a whole period apart.");
    return;
  }
  const int periods = forms.linear->periods;
  section.AddText("Formulas of the linear pendulum, over " + std::to_string(periods) +
                  (periods == 1 ? " period" : " periods") + " from turning point " +
                  std::to_string(forms.linear->first + 1) + " on" +
                  (forms.gravity.is_linear() ? "."
                                             : "; corrected_inertia: each period divided by the elliptic integral's "
                                               "ratio."));
  section.Add(EstimateTable(LinearEstimates(*forms.linear, forms.gravity, rig), false));
}

/// Warns about negative friction, which would add energy.
void WarnOfNegativeFriction(const TurningPointFit& decrement, Section& section) {
  constexpr double kSurely = 3;
  const std::vector<ParameterInfo> infos = PhysicalParameters(decrement.model);
  for (std::size_t k = 0; k < decrement.friction.size(); ++k) {
    const auto [value, error] = decrement.friction[k];
    if (value >= -kSurely * error) continue;
    section.AddText(std::string(infos[k + 1].name) + " is negative by " + NumberText(-value / error, 2) +
                        " standard errors, which is impossible for friction: the turning points follow another law.",
                    Emphasis::kCaution);
  }
}

void AddDecrement(const IdentifiedRecording& recording, const std::optional<Rig>& rig, Section& section) {
  const ClosedForms& forms = *recording.closed_forms;
  if (!forms.decrement) {
    section.AddText("No law was fitted to the turning points: " + forms.no_decrement + ".");
    return;
  }
  const TurningPointFit& decrement = *forms.decrement;
  std::vector<ReportedEstimate> estimates = DecrementEstimates(decrement, recording.data.unit, rig);
  if (const auto sticking = StickingAngle(decrement)) estimates.push_back(*sticking);
  section.AddText("Fitted to all " + std::to_string(forms.table.points.size()) + " turning points, " +
                  (forms.gravity.is_linear() ? "small angles" : "exact at any amplitude") +
                  ", with the friction of model " + recording.closed_forms_model + ": chi-square " +
                  NumberText(decrement.chi_square, 3) + " for " + std::to_string(decrement.freedom) +
                  " degrees of freedom, p " + ProbabilityText(decrement.Probability()) + ".");
  section.Add(EstimateTable(estimates, true));
  WarnOfNegativeFriction(decrement, section);
}

// --- the check -------------------------------------------------------------------------------------------------------

/// z with one decimal.
std::string ZText(const std::optional<double>& z) { return z && std::isfinite(*z) ? RoundedText(*z, {1, 0}) : "-"; }

constexpr const char* kDiffers = "NO";

/// The fitted value is rounded by its error; without an error it has the last decimal of the closed form.
Cells CheckCells(const ClosedFormRow& row) {
  const QuantityNumbers numbers(row.closed_form, row.std_error);
  const std::string value = numbers.Error().empty() ? numbers.Number(row.closed_form) : numbers.Value();
  const bool has_error = row.fit_std_error.value_or(0) > 0;
  const std::string fit =
      has_error ? QuantityNumbers(row.fit, row.fit_std_error).Number(row.fit) : numbers.Number(row.fit);
  return {row.quantity, value, numbers.Error(), fit, ZText(row.z), !row.agrees ? "-" : *row.agrees ? "yes" : kDiffers};
}

Section CheckSection(const ClosedFormCheck& check) {
  Section section{"Closed forms against the fit"};
  Table table{{{"quantity"}, {"formula", true}, {"± error", false, 1}, {"fit", true}, {"z", true}, {"agrees"}}};
  table.caution = kDiffers;
  for (const ClosedFormRow& row : check.rows) table.rows.push_back(CheckCells(row));
  section.Add(std::move(table));
  for (const ClosedFormRow& row : check.rows)
    section.AddText(row.why.empty() ? "" : row.quantity + ": " + row.why + ".");
  for (const std::string& summary : {check.overlay.summary, check.summary}) {
    section.AddText(summary.empty() ? "" : summary + ".");
  }
  return section;
}

// --- turning points --------------------------------------------------------------------------------------------------

/// Number of listed turning points at the beginning and at the end.
struct Listed {
  std::size_t first, last;
};

constexpr Listed kBesideAFit = {10, 2};
constexpr Listed kAlone = {58, 2};
constexpr Listed kFolded = {998, 2};  // in the page, which folds the table

std::vector<Column> TurningPointColumns(const TurningPointTable& table, const std::string& unit) {
  const std::string quantity = table.quantity == Quantity::kRate ? "rate" : "angle";
  return {{"number", true},
          {"t [s]", true},
          {quantity + " [" + unit + "]", true},
          {"ζ (pair)", true},
          {"± error", false, 1},
          {"ζ over n", true},
          {"± error", false, 1},
          {"n", true}};
}

/// A value and its error in two cells; empty if missing.
std::array<std::string, 2> RatioCells(const std::optional<Estimate>& ratio) {
  if (!ratio) return {"", ""};
  const QuantityNumbers numbers(ratio->value, ratio->std_error);
  return {numbers.Value(), numbers.Error()};
}

Cells TurningPointCells(const ClosedForms& forms, std::size_t i, double factor) {
  const TurningPoint& point = forms.table.points[i];
  const QuantityNumbers time(point.time, std::sqrt(point.covariance(0, 0)));
  const QuantityNumbers value(point.value, std::sqrt(point.covariance(1, 1)), factor);
  Cells cells = {std::to_string(i + 1), time.Number(point.time), value.Number(point.value), "", "", "", "", ""};
  if (i >= forms.decay.size()) return cells;
  const DecayRow& decay = forms.decay[i];
  std::ranges::copy(RatioCells(decay.pair), cells.begin() + 3);
  std::ranges::copy(RatioCells(decay.so_far), cells.begin() + 5);
  if (decay.so_far) cells[7] = std::to_string(decay.periods);
  return cells;
}

Section TurningPointSection(const IdentifiedRecording& recording, const Listed& listed) {
  const ClosedForms& forms = *recording.closed_forms;
  const std::optional<Conversion> degrees = Degrees(recording.data.unit);
  const Conversion shown = degrees.value_or(Conversion{recording.data.unit});
  const std::size_t count = forms.table.points.size();
  const std::size_t left_out = count - std::min(count, listed.first + listed.last);
  Table table{TurningPointColumns(forms.table, std::string(shown.unit)), {}};
  if (left_out > 0) {
    table.rows_before = listed.first;
    table.left_out = "... " + std::to_string(left_out) +
                     (left_out == 1 ? " more turning point" : " more turning points") +
                     "; write all of them with --series";
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (left_out > 0 && i == listed.first) i += left_out;
    table.rows.push_back(TurningPointCells(forms, i, shown.factor));
  }
  const std::string remark = "ζ: damping ratio of a pair, and over n periods";
  return {"Turning points", remark, {std::move(table)}};
}

}  // namespace

Sections SamplingSections(const std::optional<Sampling>& known) {
  if (!known) return {};
  const Sampling& sampling = *known;
  Facts facts = {{"rate", NumberText(sampling.rate_hz, kTextDigits) + " Hz, " + JitterText(sampling)},
                 {"gaps", GapsText(sampling)}};
  if (sampling.frequency_hz > 0) facts.push_back({"swing", SwingText(sampling)});
  if (sampling.start_counts > 0) facts.push_back({"levels", LevelsText(sampling)});
  if (sampling.saturated > 0) {
    facts.push_back({"saturated", std::to_string(sampling.saturated) + " readings at an end of the sensor's range"});
  }
  return {{"Sampling", "", {std::move(facts)}}};
}

Sections ClosedFormSections(const Identification& identification, std::size_t k, FitsInFull which) {
  const IdentifiedRecording& recording = identification.recordings[k];
  Section forms{"Closed forms"};
  if (!recording.closed_forms) {
    if (recording.no_closed_forms.empty()) return {};
    return {forms.AddText("There are none: " + recording.no_closed_forms + ".")};
  }
  AddLinear(*recording.closed_forms, identification.si_rig(), forms);
  AddDecrement(recording, identification.si_rig(), forms);
  if (!recording.closed_forms->envelope.empty()) forms.Add(Facts{{"envelope", recording.closed_forms->envelope}});
  Sections sections = {std::move(forms)};
  for (std::size_t i = 0; i < recording.checks.size(); ++i) {
    if (which == FitsInFull::kMain && !identification.IsShownInFull(i)) continue;
    sections.push_back(CheckSection(recording.checks[i]));
    if (recording.checks.size() > 1) sections.back().law = identification.fits[i].model.name;
  }
  const Listed& listed = which == FitsInFull::kAll ? kFolded : identification.fits.empty() ? kAlone : kBesideAFit;
  sections.push_back(TurningPointSection(recording, listed));
  return sections;
}

}  // namespace pendulum
