// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/agreement_section.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "pendulum/report/text_parts.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::agreement_section_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// The section on agreement, with no-break spaces replaced by blanks.
std::string Agreement(const Identification& report, TextStyle style = {}) {
  return WithBlanks(ToText(Sections{AgreementSection(report, 0)}, style));
}

// Expected positions: the strip has 21 places from 0.078312 (first - 1.96 errors) to 0.079884 (second + 1.96 errors),
// 0.0000786 each. 0.0789 is at 7.5, its upper end at 15.0; 0.0791 is at 10.0; the joint 0.0790 ± 0.00049 is at 2.5 to
// 8.8 to 15.0; the mean 0.078972 ± 0.00047 is at 2.4 to 8.4 to 14.4.
TEST(AgreementSection, DrawsRecordingsJointFitAndMean) {
  EXPECT_THAT(Agreement(ExampleJointIdentification()), HasSubstr(R"([[Do the recordings agree?]]
    Verdict: the recordings agree on inertia, viscous.
    inertia [kg m^2]                        z
    1 separate        0.07890 ± 0.00030  -0.4  -------*--------
    2 separate         0.0791 ± 0.0004    0.4  ----------*----------
    joint             0.07900 ± 0.00025           ------*------
    random effects    0.07897 ± 0.00024          ------*------
    Agreement: chi-square 0.16, 1 degree)"));
}

TEST(AgreementSection, ReportsTheScatterBetweenRecordings) {
  EXPECT_THAT(Agreement(ExampleJointIdentification()), HasSubstr(R"( p 0.69. Random effects:
    mean in [0.07590, 0.08200] (95 %); between recordings a standard deviation
    of 0 kg m^2, in [0, 0.005].
)"));
}

TEST(AgreementSection, CountsDegreesOfFreedom) {
  Identification report = ExampleJointIdentification();
  EXPECT_THAT(Agreement(report), HasSubstr(" 0.16, 1 degree of freedom, "));
  report.across[0].homogeneity->parameters[0].dof = 2;
  EXPECT_THAT(Agreement(report), HasSubstr(" 0.16, 2 degrees of freedom, "));
}

// Expected positions: the widest interval, of the mean 0.0034 ± 0.00196, has 21 places of 0.0002. In it 0.0025 ±
// 0.00049 has places 3 to 8, 0.0045 ± 0.00098 has 10 to 20, and 0.0033 is at 9.
TEST(AgreementSection, MarksTheJointEstimateOutsideAnInterval) {
  Identification report = ExampleJointIdentification();
  report.fits[0].parameters[1].estimate = 0.0033;
  const std::string text = Agreement(report);
  const auto row = [&](const std::string& name) {
    const std::size_t at = text.find("    " + name, text.find("viscous [N m s/rad]"));
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_THAT(row("1 separate"), EndsWith("   --*---|"));
  EXPECT_THAT(row("2 separate"), EndsWith("         |-----*-----"));
  EXPECT_THAT(row("joint"), Not(HasSubstr("|")));
}

TEST(AgreementSection, HighlightsDisagreement) {
  Identification report = ExampleJointIdentification();
  const std::string caution = "\x1B[33mVerdict: ";  // SGR 33 of ECMA-48: yellow
  EXPECT_THAT(Agreement(report, {.colour = true}), Not(HasSubstr(caution)));
  report.across[0].homogeneity->matters = true;
  report.across[0].homogeneity->verdict = "the recordings do not agree on inertia, viscous";
  EXPECT_THAT(Agreement(report, {.colour = true}), HasSubstr(caution + "the recordings do not agree"));
}

TEST(AgreementSection, HasOnlyAVerdictWithoutATest) {
  Identification report = ExampleJointIdentification();
  report.across[0].homogeneity = Homogeneity();
  report.across[0].homogeneity->verdict = "not tested: all shared parameters are fixed";
  EXPECT_EQ(Agreement(report),
            "[[Do the recordings agree?]]\n    Verdict: not tested: all shared parameters are fixed.\n");
}

TEST(AgreementSection, HasADashForAnUninformativeRecording) {
  Identification report = ExampleJointIdentification();
  report.across[0].homogeneity->parameters[0].runs[0] = {};
  EXPECT_THAT(Agreement(report), testing::ContainsRegex("    1 separate +-\n    2 separate +0.0791"));
}

TEST(AgreementSection, OmitsTheJointEstimateOfAFailedFit) {
  Identification report = ExampleFailedJointIdentification();
  report.fits[0].parameters.clear();
  const std::string text = Agreement(report);
  EXPECT_THAT(text, Not(HasSubstr("\n    joint")));
  EXPECT_THAT(text, HasSubstr("\n    random effects"));
}

// The unit "1" of a dimensionless parameter, such as dry friction without a rig, is not printed.
TEST(AgreementSection, HasNoUnitForADimensionlessNumber) {
  Identification report = ExampleJointIdentification();
  report.across[0].homogeneity->parameters[1].unit = "1";
  report.across[0].homogeneity->parameters[1].scatter.between = 0.00125;
  EXPECT_THAT(Agreement(report), Not(testing::ContainsRegex("0\\.0013[ \n]+1,")));
}

}  // namespace
}  // namespace pendulum::agreement_section_test
