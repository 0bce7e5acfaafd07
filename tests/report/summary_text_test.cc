// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/summary_text.h"

#include <array>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/layout.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::summary_text_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The text without line breaks.
std::string Unbroken(const std::string& text) {
  std::istringstream stream(text);
  std::string unbroken;
  for (std::string word; stream >> word;) unbroken += (unbroken.empty() ? "" : " ") + word;
  return unbroken;
}

/// The summary of the example with these warnings only, in one string.
std::string TextWith(std::vector<Warning> warnings) {
  Identification identification = ExampleIdentification();
  identification.fits[0].warnings = std::move(warnings);
  return Unbroken(SummaryText(SummarizeResult(identification), "More."));
}

TEST(SummaryText, HasAtMostTwentyLinesOfEightyColumns) {
  Identification identification = ExampleIdentification();
  for (int i = 0; i < 30; ++i) {
    identification.warnings.push_back(
        {"jitter", "warning number " + std::to_string(i) + " has a first clause", "and a second"});
  }
  const std::vector<std::string> lines = Lines(SummaryText(SummarizeResult(identification), "More."));
  EXPECT_LE(lines.size(), 20);
  for (const std::string& line : lines) EXPECT_LE(DisplayWidth(line), 80) << line;
  EXPECT_THAT(lines.back(), HasSubstr("More."));
}

// What changes the numbers has a line with its flag, however little room there is, and not only its code in words.
TEST(SummaryText, SaysEachAssumptionWithItsFlag) {
  Identification identification = ExampleIdentification();
  for (int i = 0; i < 30; ++i) identification.warnings.push_back({"jitter", "warning number " + std::to_string(i)});
  identification.warnings.push_back(
      {.code = "time_unit_assumed", .finding = "a long sentence", .assumed = "times in ms (--time_column t:s)"});
  identification.warnings.push_back(
      {.code = "gravity_assumed", .finding = "another one", .assumed = "g 9.80665 m/s^2 (--g)"});
  const std::string text = Unbroken(SummaryText(SummarizeResult(identification), "More."));
  EXPECT_THAT(text, HasSubstr("Assumed: times in ms (--time_column t:s); g 9.80665 m/s^2 (--g)"));
  EXPECT_THAT(text, Not(HasSubstr("time unit assumed")));
  EXPECT_THAT(text, Not(HasSubstr("a long sentence")));
}

// The zero and the textbook's formulas stand there with two warnings too.
TEST(SummaryText, KeepsTheZeroAndTheTextbookBesideWarnings) {
  const std::string text = TextWith({{"gaps", "the recording has gaps, which this long sentence describes in words"},
                                     {"zero_drift", "the zero drifts, which this long sentence describes in words"}});
  EXPECT_THAT(text, HasSubstr("zero_angle"));
  EXPECT_THAT(text, HasSubstr("textbook"));
  EXPECT_THAT(text, HasSubstr("the zero drifts"));
}

TEST(SummaryText, LeavesOutTheFirstHalfSwingBeforeTheEquationAndAllLossesLast) {
  Identification identification = ExampleIdentification();
  identification.fits[0].derived = {{"viscous_loss_share", "1", 0.6, 0.03},
                                    {"dry_loss_share", "1", 0.4, 0.03},
                                    {"viscous_loss_share_first_half_swing", "1", 0.7, 0.02},
                                    {"dry_loss_share_first_half_swing", "1", 0.3, 0.02}};
  const auto text = [&](int warnings) {
    for (int i = 0; i < warnings; ++i) {
      identification.warnings.push_back({"prior_conflict", "conflict " + std::to_string(i) + " in a sentence"});
    }
    return Unbroken(SummaryText(SummarizeResult(identification), "More."));
  };
  EXPECT_THAT(text(0), HasSubstr("dry friction 40.0 ± 3.0 %. "));
  EXPECT_THAT(text(0), HasSubstr("sin th = 0"));
  EXPECT_THAT(text(30), Not(HasSubstr("energy lost")));
  EXPECT_THAT(text(30), Not(HasSubstr("textbook")));
}

// Warnings without room are named, not cut.
TEST(SummaryText, NamesTheWarningsThatItDoesNotShow) {
  const std::string words = " in a sentence that is longer than one line of eighty columns, so that there is no room";
  std::vector<Warning> warnings;
  for (const WarningCode code :
       std::array<WarningCode, 7>{"gaps", "jitter", "spikes", "stray_lines", "unwrapped", "vibration", "event_driven"})
    warnings.push_back({code, "this is " + std::string(code.text()) + words});
  const std::string text = TextWith(warnings);
  EXPECT_THAT(text, HasSubstr("gaps, jitter, spikes, stray lines, unwrapped, vibration, event driven."));
  EXPECT_THAT(text, Not(HasSubstr("this is")));
}

// A warning that the numbers may be wrong stands before the others and is not reduced to its name.
TEST(SummaryText, ShowsEachSeriousWarning) {
  Identification identification = ExampleIdentification();
  for (int i = 0; i < 30; ++i) identification.warnings.push_back({"jitter", "warning number " + std::to_string(i)});
  constexpr std::array<WarningCode, 3> kCodes = {"another_minimum", "hold_disagrees", "prior_conflict"};
  for (const WarningCode code : kCodes)
    identification.warnings.push_back({code, "the reason is " + std::string(code.text())});
  const std::string text = Unbroken(SummaryText(SummarizeResult(identification), "More."));
  for (const WarningCode code : kCodes) EXPECT_THAT(text, HasSubstr("the reason is " + std::string(code.text())));
}

TEST(SummaryText, LeavesOutWholeParenthesesWhereThereIsNoRoom) {
  Identification identification = ExampleIdentification();
  for (int i = 0; i < 10; ++i) identification.warnings.push_back({"prior_conflict", "conflict " + std::to_string(i)});
  identification.warnings.push_back({"another_minimum", "this is (as AR(1)) short"});
  const std::string text = Unbroken(SummaryText(SummarizeResult(identification), "More."));
  EXPECT_THAT(text, HasSubstr("this is short;"));
  EXPECT_THAT(text, Not(HasSubstr("AR(1)")));
}

TEST(SummaryText, BeginsAComparisonWithTheRecommendation) {
  const ResultSummary summary = SummarizeResult(ExampleComparedIdentification());
  EXPECT_THAT(summary.laws, SizeIs(1));  // the other one has no result
  const std::string text = SummaryText(summary, "");
  EXPECT_LT(text.find("Recommended: "), text.find("inertia"));
}

// A law that was not fitted has no residuals: a row of zeros would say that it fits best.
TEST(SummaryText, SaysWhyALawHasNoResult) {
  Identification identification = ExampleComparedIdentification();
  ComparisonRow& row = identification.comparison->rows.back();
  row.judged = false;
  row.rms = 0;
  row.reason = "the fit did not converge; more";
  const std::string text = SummaryText(SummarizeResult(identification), "");
  EXPECT_THAT(text, HasSubstr("No result with " + row.model + ": the fit did not converge; more."));
  EXPECT_THAT(text, Not(HasSubstr(row.model + "  ")));
}

TEST(SummaryText, GivesTheVerdictOfAgreementOfSeveralRecordings) {
  const std::string text = SummaryText(SummarizeResult(ExampleJointIdentification()), "");
  EXPECT_THAT(text, StartsWith("[[2 recordings of one rig]]"));
  EXPECT_LT(text.find("recordings agree"), text.find("inertia  "));
}

}  // namespace
}  // namespace pendulum::summary_text_test
