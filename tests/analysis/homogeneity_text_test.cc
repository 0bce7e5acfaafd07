// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/homogeneity_text.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::homogeneity_text_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Three recordings; inertia 1.00, 1.00 and 1.03 ± 0.01 kg m², viscous 2 in all.
Homogeneity Example(double p) {
  SharedParameter inertia;
  inertia.name = "inertia";
  inertia.unit = "kg m^2";
  inertia.runs = {{1.0, 0.01, -1.0}, {1.0, 0.01, -1.0}, {1.03, 0.01, 5.0}};
  inertia.statistic = 12;
  inertia.scatter.mean = 1;
  inertia.scatter.between = 0.015;
  SharedParameter viscous = inertia;
  viscous.name = "viscous";
  viscous.runs = {{2.0, 0.1, 0.0}, {2.0, 0.1, 0.0}, {2.0, 0.1, 0.0}};
  viscous.statistic = 0;
  Homogeneity result;
  result.statistic = 12.5;
  result.dof = 4;
  result.p = p;
  result.parameters = {inertia, viscous};
  return result;
}

/// The sentences for fits with or without the warning of a lack of fit.
std::string WordsOf(const Homogeneity& result, bool lack_of_fit = false) {
  const Recording recording;
  const FitOptions options;
  FitReport fit;
  if (lack_of_fit) fit.warnings = {{"lack_of_fit", ""}};
  std::vector<RunAlone> runs;
  for (int k = 1; k <= 3; ++k) runs.push_back({"recording " + std::to_string(k), recording, fit, options, nullptr});
  return DescribeHomogeneity(result, runs);
}

TEST(DescribeHomogeneity, ReportsAgreement) {
  EXPECT_EQ(WordsOf(Example(0.5)),
            "the recordings agree on inertia, viscous (chi-square 12.5, 4 degrees of freedom, p 0.5)");
}

TEST(DescribeHomogeneity, NamesAParameterThatDisagreesOnItsOwn) {
  Homogeneity result = Example(0.02);
  result.parameters[0].p = 0.004;
  EXPECT_THAT(WordsOf(result), EndsWith(", p 0.02); on its own, inertia does not agree (p 0.004)"));
}

TEST(DescribeHomogeneity, NamesTheParametersThatDiffer) {
  Homogeneity result = Example(0.001);
  result.parameters[0].p = 0.004;
  EXPECT_THAT(WordsOf(result), StartsWith("the recordings do not agree on inertia (chi-square"));
}

TEST(DescribeHomogeneity, HasASingularForOneDegreeOfFreedom) {
  Homogeneity result = Example(0.5);
  result.dof = 1;
  EXPECT_THAT(WordsOf(result), HasSubstr(" 1 degree of freedom, "));
}

TEST(DescribeHomogeneity, ReportsTheEffectOfMisfitOnErrors) {
  EXPECT_THAT(WordsOf(Example(0.5), true), EndsWith("which makes the errors larger"));
  EXPECT_THAT(
      WordsOf(Example(0.001), true),
      EndsWith(
          "so the errors compared here may be too small, and another law may explain the differences (--models all)"));
}

TEST(DescribeHomogeneity, NamesTheOutlierAndItsDistance) {
  Homogeneity result = Example(0.001);
  result.disagreeing = {2};
  const std::string words = WordsOf(result);
  EXPECT_THAT(words, StartsWith("the recordings do not agree on inertia, viscous (chi-square 12.5, "));
  EXPECT_THAT(words, HasSubstr("; recording 3 disagrees with the others: its inertia is 3 % larger"));
  EXPECT_THAT(words, EndsWith("; fit the others without it"));
  EXPECT_THAT(WordsOf(result, true), Not(HasSubstr("fit the others")));  // the law may be wrong
  result.parameters[0].runs[2].value = 0.98;
  EXPECT_THAT(WordsOf(result), HasSubstr("its inertia is 2 % smaller"));
}

TEST(DescribeHomogeneity, NamesSeveralOutliers) {
  Homogeneity result = Example(0.001);
  result.disagreeing = {1, 2};
  EXPECT_THAT(WordsOf(result), AllOf(HasSubstr("; recording 2 disagrees"), HasSubstr("; recording 3 disagrees"),
                                     EndsWith("; fit the others without them")));
}

TEST(DescribeHomogeneity, ReportsDifferencesExplainedByAmplitude) {
  Homogeneity result = Example(0.001);
  result.amplitude_dependence = {{"inertia", "kg m^2", 0.1, 0.01, 0.0025, -0.02, 0.5},
                                 {"viscous", "kg m^2", 0.1, 0.1, 0.5, 0.4, 0.5}};
  const std::string words = WordsOf(result);
  EXPECT_THAT(words, AllOf(HasSubstr("; inertia falls by 2 % from the recording with the smallest swings"),
                           HasSubstr("(p 0.0025), and nothing else differs"), Not(HasSubstr("viscous rises"))));
  result.amplitude_dependence[0].rest_p = 0.001;
  EXPECT_THAT(WordsOf(result), HasSubstr(", but other differences remain"));
  result.disagreeing = {2};
  EXPECT_THAT(WordsOf(result), Not(HasSubstr("inertia falls")));
}

TEST(DescribeHomogeneity, NamesTheParameterThatScattersMost) {
  EXPECT_THAT(WordsOf(Example(0.001)), HasSubstr("between recordings inertia scatters by 1.5 %, beyond its errors"));
  Homogeneity result = Example(0.001);
  result.parameters[1].statistic = 20;
  result.parameters[1].scatter.mean = 0;
  EXPECT_THAT(WordsOf(result), HasSubstr("between recordings viscous scatters by 0.015 kg m^2, beyond its errors"));
  EXPECT_THAT(WordsOf(result), EndsWith("another law may explain that (--models all); if not, the random-effects means "
                                        "and their errors are the rig's constants"));
  EXPECT_THAT(WordsOf(result, true), Not(HasSubstr("the rig's constants")));
}

TEST(DescribeHomogeneity, ReportsInertiasOfDifferentRigs) {
  Homogeneity result = Example(0.001);
  result.parameters[0].scatter.between = 0.1;
  const char* const words =
      "; inertia differs by 10 % (standard deviation): the recordings are of different rigs, or of one rig at "
      "different lengths";
  EXPECT_THAT(WordsOf(result), EndsWith(words));
  result.amplitude_dependence = {{"inertia", "kg m^2", 0.1, 0.01, 0.0025, -0.02, 0.5}};
  EXPECT_THAT(WordsOf(result), EndsWith(words));  // no other law is recommended
  result.disagreeing = {2};
  result.parameters[0].runs[2].value = 2.06;
  EXPECT_THAT(WordsOf(result), HasSubstr("its inertia is 106 % larger"));
}

}  // namespace
}  // namespace pendulum::homogeneity_text_test
