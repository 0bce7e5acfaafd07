// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/summary_text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/model/parameter.h"
#include "pendulum/report/fit_sections.h"
#include "pendulum/report/layout.h"

namespace pendulum {
namespace {

/// What a text folds to be short, each besides those before it.
enum class Folding {
  kNone,
  kSensorParameters,  // The parameters of the sensor (its zero, bias, drift, axis) and the initial rate are in one
                      // line.
  kAsides,            // Warnings have no parentheses.
  kWarnings,          // All warnings are in one paragraph.
  kRemarks,           // Remarks, derived quantities and the textbook's formulas are in one paragraph.
  kHalfSwing,         // No losses of the first half swing.
  kNames,             // Warnings that are not serious are only named.
  kEquation,          // No equation: the table has its numbers.
  kParagraphs,        // Window and verdict are in one paragraph, assumptions and warnings too.
  kAdvice,            // Nothing on the largest error.
  kReasons,           // The textbook's values have no reasons.
  kTextbook,          // No textbook's values.
  kTogether,          // Remarks and assumptions are in one paragraph, without what no swing can tell.
  kLosses             // No losses.
};

constexpr std::array kFoldings = {Folding::kNone,       Folding::kSensorParameters,
                                  Folding::kAsides,     Folding::kWarnings,
                                  Folding::kRemarks,    Folding::kHalfSwing,
                                  Folding::kNames,      Folding::kEquation,
                                  Folding::kParagraphs, Folding::kAdvice,
                                  Folding::kReasons,    Folding::kTextbook,
                                  Folding::kTogether,   Folding::kLosses};

/// Adds a sentence or a list item to a text.
void Join(const std::string& more, std::string_view separator, std::string& text) {
  if (!more.empty()) text.append(text.empty() ? "" : separator).append(more);
}

bool IsOfSensor(const SummaryQuantity& quantity) {
  constexpr std::array kOfSensor = {
      kZeroAngle.name, kRateBias.name,   kRateScale.name,  kAccelerationBias.name, kAccelerationScale.name,
      kAxis.name,      kRadius.name,     kPivotX.name,     kPivotY.name,           kZeroDrift.name,
      kBiasDrift.name, kHysteresis.name, kInitialRate.name};
  return std::ranges::find(kOfSensor, quantity.name) != kOfSensor.end();
}

// ---- Tables ---------------------------------------------------------------------------------------------------------

Table LawTable(const ResultSummary& summary) {
  Table table{{{"law"}, {"rms residual", true}, {"ΔBIC", true}, {""}}};
  table.caution = "lack of fit";
  for (const SummaryLaw& law : summary.laws) {
    table.rows.push_back({law.name, law.rms, law.delta.empty() ? "-" : law.delta, law.verdict});
  }
  return table;
}

Table ParameterTable(const FitSummary& summary, Folding folding) {
  Table table{{{summary.law.empty() ? "formulas" : summary.law},
               {"value", true},
               {summary.has_systematic ? "± total error" : "± std error", false, 1},
               {"unit"},
               {"error from"}}};
  for (const SummaryQuantity& quantity : summary.parameters) {
    if (folding >= Folding::kSensorParameters && IsOfSensor(quantity)) continue;
    table.rows.push_back({quantity.name, quantity.value, quantity.error.empty() ? "" : "± " + quantity.error,
                          quantity.unit, quantity.source});
  }
  return table;
}

// ---- Sentences ------------------------------------------------------------------------------------------------------

std::string QuantityText(const SummaryQuantity& quantity) {
  const std::string blank(kNoBreak);
  return quantity.name + blank + quantity.value + (quantity.error.empty() ? "" : blank + "±" + blank + quantity.error) +
         (quantity.unit.empty() ? "" : blank + quantity.unit);
}

/// Quantities and what gives them in SI units.
std::string DerivedText(const FitSummary& summary) {
  std::string text;
  for (const SummaryQuantity& quantity : summary.derived) Join(QuantityText(quantity), ", ", text);
  if (!summary.units.empty() && !text.empty()) text += ".";
  Join(summary.units, " ", text);
  return text;
}

/// The parameters that the table leaves out.
std::string OmittedText(const FitSummary& summary, Folding folding) {
  std::string text;
  for (const SummaryQuantity& quantity : summary.parameters) {
    if (folding >= Folding::kSensorParameters && IsOfSensor(quantity)) Join(QuantityText(quantity), ", ", text);
  }
  return text.empty() ? "" : "Also fitted: " + text + ".";
}

std::string AssumedText(const FitSummary& summary, Folding folding) {
  std::string text;
  for (const std::string& assumption : summary.assumptions) Join(assumption, "; ", text);
  if (folding < Folding::kTogether) Join(summary.untold, "; ", text);
  return text.empty() ? "" : "Assumed: " + text + ".";
}

// ---- Warnings -------------------------------------------------------------------------------------------------------

/// The place of the parenthesis that closes the one at `open`; npos if there is none.
std::size_t ClosingOf(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t k = open; k < text.size(); ++k) {
    if (text[k] == '(') ++depth;
    if (text[k] == ')' && --depth == 0) return k;
  }
  return std::string::npos;
}

/// A message without its parentheses, except those with a flag.
std::string WithoutAsides(std::string text) {
  std::size_t open = text.find(" (");
  while (open != std::string::npos) {
    const std::size_t close = ClosingOf(text, open + 1);
    if (close == std::string::npos) break;
    const bool keeps = text.substr(open, close - open).find("--") != std::string::npos;
    if (!keeps) text.erase(open, close + 1 - open);
    open = text.find(" (", keeps ? close : open);
  }
  return text;
}

/// "zero drift": the code in words.
std::string NameOf(const Warning& warning) {
  std::string name(warning.code.text());
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// Warnings that are said, and the names of those that are only named.
struct WarningTexts {
  std::vector<std::string> sentences, names;
};

WarningTexts TextsOf(const FitSummary& fit, Folding folding) {
  WarningTexts texts;
  for (const Warning& warning : fit.warnings) {
    if (folding < Folding::kNames || warning.code.is_serious()) {
      const std::string text = fit.TextOf(warning);
      texts.sentences.push_back(folding >= Folding::kAsides ? WithoutAsides(text) : text);
    } else if (std::ranges::find(texts.names, NameOf(warning)) == texts.names.end()) {
      texts.names.push_back(NameOf(warning));
    }
  }
  return texts;
}

/// All warnings in one paragraph.
std::string WarningsText(const WarningTexts& warnings) {
  std::string text, list;
  for (const std::string& sentence : warnings.sentences) Join(sentence, "; ", text);
  for (const std::string& name : warnings.names) Join(name, ", ", list);
  if (!list.empty()) Join((text.empty() ? "" : "more: ") + list, "; ", text);
  if (text.empty()) return "";
  return (warnings.sentences.size() + warnings.names.size() > 1 ? "Warnings: " : "Warning: ") + text + ".";
}

/// remarks: the paragraph before them.
void AddAssumptionsAndWarnings(const FitSummary& summary, Folding folding, const std::string& remarks,
                               Section& section) {
  const WarningTexts warnings = TextsOf(summary, folding);
  const bool are_together = folding >= Folding::kTogether;
  std::string text = are_together ? remarks : "";
  if (!are_together) section.AddText(remarks);
  Join(AssumedText(summary, folding), " ", text);
  if (folding >= Folding::kParagraphs) {
    Join(WarningsText(warnings), " ", text);
    section.AddText(text, warnings.sentences.empty() ? Emphasis::kNone : Emphasis::kCaution);
    return;
  }
  section.AddText(text);
  if (folding >= Folding::kWarnings) {
    section.AddText(WarningsText(warnings), Emphasis::kCaution);
    return;
  }
  for (const std::string& sentence : warnings.sentences)
    section.AddText("Warning: " + sentence + ".", Emphasis::kCaution);
}

// ---- The whole ------------------------------------------------------------------------------------------------------

/// What stands above the result of the fit: which law is recommended, and how all compare.
Section& AddComparison(const ResultSummary& summary, Section& section) {
  section.AddText(summary.comparison);
  if (!summary.laws.empty()) section.Add(LawTable(summary));
  return section.AddText(summary.without_result);
}

std::string LossesText(const FitSummary& fit, Folding folding) {
  if (folding >= Folding::kLosses) return "";
  return folding >= Folding::kHalfSwing ? WithoutAsides(fit.losses) : fit.losses;
}

std::string TextbookText(const FitSummary& fit, Folding folding) {
  if (folding >= Folding::kTextbook) return "";
  return folding >= Folding::kReasons ? WithoutAsides(fit.textbook) : fit.textbook;
}

/// Adds the remarks as paragraphs, or returns them as one.
std::string AddRemarks(const FitSummary& fit, Folding folding, Section& section) {
  std::string text;
  std::string remarks = LossesText(fit, folding);
  Join(OmittedText(fit, folding), " ", remarks);
  Join(fit.remarks, " ", remarks);
  if (folding < Folding::kAdvice) Join(fit.advice, " ", remarks);
  for (std::string part : {std::move(remarks), DerivedText(fit), TextbookText(fit, folding)}) {
    if (folding < Folding::kRemarks) {
      section.AddText(part);
      continue;
    }
    if (!part.empty() && !part.ends_with('.')) part += ".";
    Join(Capitalized(part), " ", text);
  }
  return text;
}

/// The window, the comparison of laws, and whether the law describes the readings.
void AddVerdict(const ResultSummary& summary, Folding folding, Section& section) {
  const FitSummary& fit = summary.fit;
  std::string verdict = fit.verdict;
  if (folding >= Folding::kParagraphs && summary.comparison.empty() && fit.agreement.empty()) {
    verdict = summary.data + " " + verdict;
  } else {
    section.AddText(summary.data);
  }
  AddComparison(summary, section).AddText(fit.agreement, fit.agreement_emphasis).AddText(verdict, fit.emphasis);
}

Section FoldedSection(const ResultSummary& summary, Folding folding) {
  const FitSummary& fit = summary.fit;
  Section section{summary.title};
  AddVerdict(summary, folding, section);
  if (!fit.parameters.empty()) section.Add(ParameterTable(fit, folding));
  if (!fit.equation.empty() && folding < Folding::kEquation) section.Add(Formula{WithUnbrokenTerms(fit.equation)});
  AddAssumptionsAndWarnings(fit, folding, AddRemarks(fit, folding, section), section);
  return section;
}

std::ptrdiff_t LineCount(const std::string& text) { return std::ranges::count(text, '\n'); }

}  // namespace

Section SummarySection(const ResultSummary& summary) { return FoldedSection(summary, Folding::kNone); }

std::string SummaryText(const ResultSummary& summary, const std::string& more, TextStyle style) {
  constexpr std::ptrdiff_t kMostLines = 20;
  Section comparison{""};
  const std::ptrdiff_t of_comparison = LineCount(ToText(Sections{AddComparison(summary, comparison)}, style)) - 1;
  std::string text;
  for (const Folding folding : kFoldings) {
    Section section = FoldedSection(summary, folding);
    text = ToText(Sections{section.AddText(more)}, style);
    if (LineCount(text) <= kMostLines + of_comparison) break;
  }
  return text;
}

}  // namespace pendulum
