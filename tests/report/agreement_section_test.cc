// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/joint_sections.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "pendulum/report/text.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::joint_sections_test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> Titles(const Sections& sections) {
  std::vector<std::string> titles;
  for (const Section& section : sections) titles.push_back(section.title);
  return titles;
}

/// The section with this title, as text.
std::string TextOf(const Identification& report, const std::string& title) {
  for (const Section& section : JointSections(report)) {
    if (section.title == title) return ToText(Sections{section});
  }
  return "";
}

/// The section on agreement, with no-break spaces replaced by blanks.
std::string Agreement(const Identification& report, TextStyle style = {}) {
  return WithBlanks(ToText(Sections{AgreementSection(report, 0)}, style));
}

/// The widest line of a text.
int WidestOf(const std::string& text) {
  int widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, DisplayWidth(line));
  return widest;
}

TEST(JointSections, AreInOrder) {
  EXPECT_THAT(Titles(JointSections(ExampleJointIdentification())),
              ElementsAre("Recordings", "Fit", "Parameters", "Do the recordings agree?", "Each recording's own",
                          "Derived quantities", "Correlations", "Noise and statistics", "Equation of motion",
                          "What one swing cannot tell"));
  EXPECT_THAT(
      Titles(JointSections(ExampleComparedJointIdentification())),
      ElementsAre("Recordings", "Comparison", "Likelihood-ratio tests", "Fit", "Parameters", "Do the recordings agree?",
                  "Each recording's own", "Derived quantities", "Correlations", "Noise and statistics",
                  "Equation of motion", "What one swing cannot tell", "Parameters of drag"));
}

TEST(JointSections, ShowNoMotionIfThePendulumsDiffer) {
  Identification report = ExampleJointIdentification();
  report.fits[0].termination = Termination::kNotConverged;
  EXPECT_THAT(Titles(JointSections(report)), ElementsAre("Recordings", "Fit", "Parameters", "Do the recordings agree?",
                                                         "Correlations", "Noise and statistics"));
}

// 0.25 rad = 14.3 deg, 0.125 rad = 7.16 deg.
TEST(JointSections, NumberTheRecordings) {
  EXPECT_EQ(TextOf(ExampleJointIdentification(), "Recordings"), R"([[Recordings]]
       file
    1  run.csv
    2  b c.csv
            samples  window          rate [Hz]  starts     amplitude [deg]
    1  1801 of 2000  1.5 to 19.5 s         100  held                  14.3
    2   901 of 2000  10.5 to 19.5 s        100  in motion             7.16
    Amplitudes are root mean squares over the motion.
)");
}

TEST(JointSections, DistinguishReleasesOfOneFile) {
  Identification report = ExampleJointIdentification();
  report.runs[1].data.path = "run.csv";
  report.runs[1].data.release = 2;
  EXPECT_THAT(TextOf(report, "Recordings"), HasSubstr("    1  run.csv, swing 1\n    2  run.csv, swing 2\n"));
}

TEST(JointSections, ShowADashForARecordingWithoutAFile) {
  Identification report = ExampleJointIdentification();
  report.runs[0].data.path.clear();
  EXPECT_THAT(TextOf(report, "Recordings"), HasSubstr("    1  -\n    2  b c.csv\n"));
}

TEST(JointSections, CountTheRecordingsThatShareParameters) {
  const std::string text = TextOf(ExampleJointIdentification(), "Fit");
  EXPECT_THAT(text, HasSubstr("    shared  inertia, viscous, coulomb, by 2 recordings; each recording has its\n"));
  EXPECT_THAT(text, HasSubstr("    status  converged: the estimates are within 0.1 standard errors\n"));
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
  report.joint[0].homogeneity.parameters[0].dof = 2;
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
  report.joint[0].homogeneity.p = 1e-6;
  report.joint[0].homogeneity.verdict = "the recordings do not agree on inertia, viscous";
  EXPECT_THAT(Agreement(report, {.colour = true}), HasSubstr(caution + "the recordings do not agree"));
}

TEST(AgreementSection, HasOnlyAVerdictWithoutATest) {
  Identification report = ExampleJointIdentification();
  report.joint[0].homogeneity = {};
  report.joint[0].homogeneity.verdict = "not tested: all shared parameters are fixed";
  EXPECT_EQ(Agreement(report),
            "[[Do the recordings agree?]]\n    Verdict: not tested: all shared parameters are fixed.\n");
}

TEST(AgreementSection, HasADashForAnUninformativeRecording) {
  Identification report = ExampleJointIdentification();
  report.joint[0].homogeneity.parameters[0].runs[0] = {};
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
  report.joint[0].homogeneity.parameters[1].unit = "1";
  report.joint[0].homogeneity.parameters[1].scatter.between = 0.00125;
  EXPECT_THAT(Agreement(report), Not(testing::ContainsRegex("0\\.0013[ \n]+1,")));
}

TEST(JointSections, ShowSeparateParametersOfEachRecording) {
  EXPECT_EQ(TextOf(ExampleJointIdentification(), "Each recording's own"), R"([[Each recording's own]] (by the joint fit)
       name             value ± std error  unit  95 % interval
    1  release_angle  0.42300 ± 0.00020    rad   [0.42260, 0.42340]
       zero_angle        0.01 (fixed)      rad
    2  initial_angle    0.250 ± 0.013      rad   [0.225, 0.275]
       zero_angle        0.01 (fixed)      rad
)");
}

TEST(JointSections, ShowNoiseAndSeparateStatusPerRecording) {
  const std::string text = TextOf(ExampleJointIdentification(), "Noise and statistics");
  EXPECT_THAT(text, HasSubstr("    recording 1  "));
  EXPECT_THAT(text, HasSubstr("lack of"));
  EXPECT_THAT(text, HasSubstr("separate fit:"));
  EXPECT_THAT(text, HasSubstr("not_converged: too few"));
  EXPECT_THAT(text, HasSubstr("    all          log-likelihood 1234.50, AIC -2457.00, AICc -2456.88, BIC"));
}

TEST(JointSections, ShowAnEquationOnlyIfAllParametersAreShared) {
  Identification report = ExampleJointIdentification();
  report.joint[0].shared = {"inertia"};
  EXPECT_EQ(TextOf(report, "Equation of motion"), "");
  EXPECT_THAT(TextOf(report, "Each recording's own"), HasSubstr("    1  viscous "));
}

TEST(JointSections, ShowNoNumbersOfAFailedFit) {
  const std::string text = ToText(ExampleFailedJointIdentification());
  EXPECT_THAT(text, HasSubstr("status  failed: no joint motion can be computed"));
  EXPECT_THAT(text, Not(HasSubstr("[[Noise and statistics]]")));
  EXPECT_THAT(text, Not(HasSubstr("[[Equation of motion]]")));
  EXPECT_THAT(text, Not(testing::ContainsRegex("[^a-z](nan|inf)[^a-z]")));
}

TEST(ToText, EndsAJointFitWithTheRecordingsWarnings) {
  EXPECT_THAT(ToText(ExampleJointIdentification()),
              HasSubstr("[[Warnings]]\n  - recording 1 (run.csv): there is a gap of 0.5 s after 7 s\n"));
}

// ESC [ 2 J clears a terminal. Labels of recordings occur in verdicts and in the status that repeats them.
TEST(ToText, ReplacesTerminalControlCharactersOfAJointFit) {
  Identification report = ExampleJointIdentification();
  report.runs[1].data.path = "a\x1B[2J\n.csv";
  report.runs[1].warnings = {{"gaps", "a gap"}};
  report.joint[0].homogeneity.verdict = "recording 2 (" + report.runs[1].data.path + ") disagrees with the others";
  report.fits[0].reason = "not one pendulum; " + report.joint[0].homogeneity.verdict;
  EXPECT_THAT(ToText(report), HasSubstr("    2  a?[2J?.csv\n"));
  EXPECT_THAT(ToText(report), Not(HasSubstr("\x1B")));
}

/// The example with the longest possible names, units and numbers of fits.
Identification WideReport() {
  Identification report = ExampleComparedJointIdentification();
  Homogeneity& homogeneity = report.joint[0].homogeneity;
  SharedParameter& wide = homogeneity.parameters[1];
  wide.name = "stribeck_coulomb";
  wide.unit = "N m s^2/rad^2";
  wide.runs = {{-3.2345678e-7, 1.2e-13, -12345.6}, {3.2345678e-7, 1.2e-9, 12345.6}};
  wide.scatter = {1.2345e-9, 3.2e-7, -4.1e-6, 4.1e-6, 4.5e-7, 2e-7, 1.4e-5};
  for (int i = 0; i < 12; ++i) homogeneity.verdict += "; recording 2 (b c.csv) disagrees with the others";
  homogeneity.parameters[0].runs[0] = {0.0789996123, 2.8e-9, -1e5};
  for (Identification& run : report.runs) {
    run.fits[0].parameters[3] = ExampleParameter(kReleaseTime, "rad", -123.456789012, 1.2e-9);
    run.fits[0].noise.why = "the residuals are 0.8 resolutions, " + std::string(60, 'x') + " and so on";
    run.data.samples = run.data.used_samples = 12345678;
    run.data.from = -12345.678;
    run.data.to = 98765.4321;
  }
  report.joint[0].alone[0] = "not_converged: 100 iterations were not enough, " + std::string(50, 'x') + " and so on";
  return report;
}

TEST(JointSections, FitInEightyColumns) {
  for (const Identification& report :
       {ExampleJointIdentification(), ExampleComparedJointIdentification(), ExampleFailedJointIdentification()}) {
    EXPECT_LE(WidestOf(ToText(report)), 80) << ToText(report);
  }
  EXPECT_LE(WidestOf(ToText(WideReport())), 80) << ToText(WideReport());
}

// The amplitude of a recording whose separate fit failed.
TEST(JointSections, ShowADashForAnUnknownAmplitude) {
  Identification report = ExampleJointIdentification();
  report.joint[0].homogeneity.amplitudes[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(TextOf(report, "Recordings"), testing::ContainsRegex("    1 .* held +-\n"));
}

}  // namespace
}  // namespace pendulum::joint_sections_test
