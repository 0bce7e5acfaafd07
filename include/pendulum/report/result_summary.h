// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/warning.h"
#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// A quantity as one quotes it. Value and error are rounded together (PdgText); the error is the total standard error.
struct SummaryQuantity {
  std::string name, symbol;  ///< Name in JSON, symbol in MODEL.md; a derived quantity has no symbol.
  std::string value, error;  ///< To be printed with " ± " between them; error is empty if there is none.
  std::string unit;          ///< deg instead of rad; empty for a pure number.
  std::string source;        ///< What the error comes from, "masses and length"; or why there is none, "fixed".
};

/// One law of a comparison.
struct SummaryLaw {
  std::string name;
  std::string rms;      ///< Residuals, with unit.
  std::string delta;    ///< BIC less the smallest; empty if not compared.
  std::string verdict;  ///< "recommended", "lack of fit" or empty.
};

/// What a reader needs to know of one fit, in words and rounded numbers.
struct FitSummary {
  std::string verdict;  ///< Whether the law describes the readings, or why there is no result.
  Emphasis emphasis = Emphasis::kNone;
  std::string agreement;  ///< Whether several recordings agree; empty for one.
  Emphasis agreement_emphasis = Emphasis::kNone;
  std::string law;  ///< The law of the parameters; empty without a fit.
  std::vector<SummaryQuantity> parameters;
  bool has_systematic = false;           ///< Whether any error is more than statistical.
  std::string losses;                    ///< What took the energy, with shares; empty for a law with one loss.
  std::vector<SummaryQuantity> derived;  ///< Period, decay time, quality factor; g or lengths if the rig asks for them.
  std::string equation;                  ///< With numbers.
  std::string units;                     ///< What gives SI units, if there are none; else empty.
  std::string textbook;                  ///< What the textbook's formulas give, and why it differs; may be empty.
  std::string remarks;                   ///< What a value ± error does not say of these parameters; may be empty.
  std::string advice;                    ///< What would make the largest error smaller; may be empty.
  std::vector<std::string> assumptions;  ///< What the numbers rest on that nobody said, each with its flag.
  std::string untold;                    ///< What is assumed because no free swing can tell it; empty if the rig tells.
  std::vector<Warning> warnings;         ///< Others that the verdict does not say.
  std::string path;                      ///< Of the recording; empty for several.

  /// The text of one of the warnings, printable.
  std::string TextOf(const Warning& warning) const;
};

/// What a reader of a result needs first. Every front end shows it first.
struct ResultSummary {
  std::string title;       ///< The file, or "4 recordings of one rig".
  std::string data;        ///< Samples and window.
  std::string comparison;  ///< Which law is recommended, and why; empty for one law.
  std::vector<SummaryLaw> laws;
  std::string without_result;  ///< Which laws have no result, and why; often empty.
  FitSummary fit;              ///< Of the main fit; if there is none, of closed forms.
};

/// The recording's path or `without_name`, or "4 recordings of one rig".
std::string TitleOf(const Identification& identification, const std::string& without_name);

/// The summary of one fit.
FitSummary SummarizeFit(const Identification& identification, std::size_t index);

ResultSummary SummarizeResult(const Identification& identification);

/// The parameters of the main fit, a line each: name, value, total standard error ("-" if there is none) and unit,
/// separated by blanks, in the result's own units and with 10 digits.
std::string QuietText(const Identification& identification);

/// The summary of a fit as JSON.
nlohmann::ordered_json FitSummaryJson(const FitSummary& summary);

}  // namespace pendulum
