// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/comparison_text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/rounding.h"
#include "pendulum/model/friction/asymmetric.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Row = std::vector<std::string>;

constexpr int kResidualDigits = 3;
constexpr int kWeightDigits = 2;
constexpr const char* kLackOfFit = "lack of fit";

/// Degrees for angles, otherwise the readings' own unit.
Conversion ShownUnit(const Identification& identification) {
  return Degrees(identification.unit).value_or(Conversion{identification.unit});
}

std::string FixedOrDash(const std::optional<double>& value, int decimals) {
  return value && std::isfinite(*value) ? FixedText(*value, decimals) : "-";
}

/// A number for comparison within its column: three digits, including trailing zeros.
std::string SizeText(double size) {
  if (!(size > 0) || !std::isfinite(size)) return NumberText(size, kResidualDigits);
  return RoundedText(size, SignificantRounding(size, kResidualDigits));
}

/// The text with a full stop at its end.
std::string Sentence(const std::string& text) { return text.empty() || text.ends_with('.') ? text : text + "."; }

// --- comparison ------------------------------------------------------------------------------------------------------

Table CriteriaTable(const Comparison& comparison, const Conversion& shown) {
  Table table{{{"model"},
               {"parameters", true},
               {"rms [" + std::string(shown.unit) + "]", true},
               {"ΔBIC", true},
               {"AICc weight", true},
               {"lag 1", true},
               {""}}};
  table.caution = kLackOfFit;
  for (const ComparisonRow& row : comparison.rows) {
    const bool has_weight = row.akaike_weight && std::isfinite(*row.akaike_weight);
    table.rows.push_back({row.model, row.judged ? std::to_string(row.parameters) : "-",
                          row.judged ? SizeText(shown.factor * row.rms) : "-", FixedOrDash(row.delta_bic, 1),
                          has_weight ? NumberText(*row.akaike_weight, kWeightDigits) : "-",
                          row.judged ? FixedText(row.lag1_correlation, 2) : "-",
                          row.lack_of_fit ? kLackOfFit
                          : row.judged    ? ""
                                          : "not compared"});
  }
  return table;
}

/// The rms of the prediction and its standardized rms, in two cells.
Row PredictionCells(const Prediction& prediction, double factor) {
  if (prediction.samples == 0) return {"-", "-"};
  return {SizeText(factor * prediction.rms), SizeText(prediction.standardized)};
}

Table PredictionTable(const Comparison& comparison, const Conversion& shown) {
  const std::string unit = " [" + std::string(shown.unit) + "]";
  Table table{
      {{"model"}, {"blocks" + unit, true}, {"standardized", true}, {"last part" + unit, true}, {"standardized", true}}};
  for (const ComparisonRow& row : comparison.rows) {
    Row cells = {row.model};
    for (const Prediction& prediction : {row.cross_validation, row.forward}) {
      for (std::string& cell : PredictionCells(prediction, shown.factor)) cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

bool HasPredictions(const Comparison& comparison) {
  return std::ranges::any_of(comparison.rows, [](const ComparisonRow& row) {
    return row.cross_validation.samples > 0 || row.forward.samples > 0;
  });
}

/// Says why a model is not compared, and why a prediction is missing.
void AddReasons(const Comparison& comparison, Section& section) {
  for (const ComparisonRow& row : comparison.rows) {
    if (!row.judged) {
      section.AddText(row.model + " is not compared: " + Sentence(row.reason));
      continue;
    }
    const std::string& first = row.cross_validation.reason;
    const std::string& second = row.forward.reason;
    if (!first.empty()) section.AddText(row.model + ", left-out blocks: " + Sentence(first));
    if (!second.empty())
      section.AddText(row.model + ", last part: " + (second == first ? "for the same reason." : Sentence(second)));
  }
}

Table TestTable(const Comparison& comparison) {
  Table table{{{"law"}, {"adds"}, {"2 Δ log L", true}, {"p"}, {"null distribution"}}};
  for (const NestedTest& test : comparison.tests) {
    table.rows.push_back({test.richer + " over " + test.simpler, NameList(test.added), NumberText(test.statistic, 3),
                          test.p ? ProbabilityText(*test.p) : "-", test.null});
  }
  return table;
}

Section ComparisonSection(const Comparison& comparison, const Conversion& shown) {
  const bool recommends = !comparison.recommended.empty();
  Section section{"Comparison"};
  section.AddText(recommends ? "Recommended: " + comparison.recommended + "." : "No model is recommended.",
                  recommends ? Emphasis::kNone : Emphasis::kCaution);
  section.AddText(Capitalized(Sentence(comparison.reason))).Add(CriteriaTable(comparison, shown));
  section.AddText(Sentence(comparison.criterion));
  if (HasPredictions(comparison)) {
    section.AddText(
        "Prediction of samples that were left out of the fit: block by block, and of the last part from the "
        "first part. rms: of measured - predicted; standardized: rms of this difference over its predicted standard "
        "deviation, which is 1 if model and errors are right.");
    section.Add(PredictionTable(comparison, shown));
  }
  AddReasons(comparison, section);
  return section;
}

Section TestSection(const Comparison& comparison) {
  Section section{"Likelihood-ratio tests", "small p: the simpler law lacks the added term", {TestTable(comparison)}};
  for (const NestedTest& test : comparison.tests) {
    if (!test.p) section.AddText(test.richer + " over " + test.simpler + ": no p: " + Sentence(test.reason));
  }
  return section;
}

// --- constancy -------------------------------------------------------------------------------------------------------

Table HalvesTable(const Constancy& constancy) {
  Table table{{{"name"},
               {"first half", true},
               {"± error", false, 1},
               {"second half", true},
               {"± error", false, 1},
               {"unit"},
               {"z", true}}};
  for (const HalvesRow& row : constancy.halves) {
    const QuantityNumbers first(row.first, row.first_std_error);
    const QuantityNumbers second(row.second, row.second_std_error);
    table.rows.push_back(
        {row.name, first.Value(), first.Error(), second.Value(), second.Error(), row.unit, FixedOrDash(row.z, 1)});
  }
  return table;
}

/// A value with its error; empty if missing.
Row CellsOf(double value, double std_error) {
  if (!std::isfinite(value)) return {"", ""};
  const QuantityNumbers numbers(value, std_error);
  return {numbers.Value(), numbers.Error()};
}

Table WindowTable(const Constancy& constancy) {
  const auto& trends = constancy.trends;
  const auto header = [&](std::size_t i, const std::string& name) {
    return i < trends.size() ? trends[i].name + " [" + trends[i].unit + "]" : name;
  };
  Table table{{{"from [s]", true},
               {"to [s]", true},
               {"amplitude [deg]", true},
               {header(0, "inertia"), true},
               {"± error", false, 1},
               {header(1, "friction"), true},
               {"± error", false, 1}}};
  const double degrees = Degrees("rad")->factor;
  for (const AmplitudeRow& row : constancy.windows) {
    Row cells = {FixedText(row.from, 2), FixedText(row.to, 2), FixedText(degrees * row.amplitude, 2)};
    for (const Row& more :
         {CellsOf(row.inertia, row.inertia_std_error), CellsOf(row.friction, row.friction_std_error)}) {
      cells.insert(cells.end(), more.begin(), more.end());
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// Whether a table shows friction below 0, which is outside the fit's own bound.
bool HasNegativeFriction(const Constancy& constancy) {
  const auto in_half = [](const HalvesRow& row) {
    return row.name != kAsymmetry.name && (row.first < 0 || row.second < 0);
  };
  const auto in_window = [](const AmplitudeRow& row) { return row.friction < 0; };
  return (constancy.halves_differ() && std::ranges::any_of(constancy.halves, in_half)) ||
         (constancy.windows_differ() && std::ranges::any_of(constancy.windows, in_window));
}

}  // namespace

Sections ComparisonSections(const Identification& identification) {
  if (!identification.comparison) return {};
  Sections sections = {ComparisonSection(*identification.comparison, ShownUnit(identification))};
  if (!identification.comparison->tests.empty()) sections.push_back(TestSection(*identification.comparison));
  return sections;
}

Sections ConstancySections(const Constancy* constancy) {
  if (constancy == nullptr || (constancy->verdict.empty() && constancy->reason.empty())) return {};
  Section section{"Constancy"};
  section.AddText(Sentence(constancy->verdict), constancy->constant() ? Emphasis::kNone : Emphasis::kCaution);
  if (constancy->halves_differ()) section.Add(HalvesTable(*constancy));
  if (constancy->windows_differ()) section.Add(WindowTable(*constancy));
  if (HasNegativeFriction(*constancy)) {
    section.AddText("Parts are fitted without bounds, so a single part may show friction below 0.");
  }
  const bool said = constancy->verdict.find(constancy->reason) != std::string::npos;
  if (!said) section.AddText("Not tested: " + Sentence(constancy->reason));
  return {std::move(section)};
}

}  // namespace pendulum
