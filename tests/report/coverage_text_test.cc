// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/coverage_text.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::coverage_text_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Two parameters: one that passes, and one at its bound whose coverage fails.
CoverageStudy ExampleStudy() {
  CoverageStudy study;
  study.scenario.name = "breeze";
  study.scenario.description = "a window left open";
  study.recordings = 1000;
  study.converged = 998;
  study.failed = 1;
  study.rows.resize(2);
  study.rows[0] = {"inertia", "kg m^2", false, 949, 2, 0.949, 0.9335, 0.9618, 1.5612e-6, 1.0261, 0.9874, true, true};
  study.rows[1] = {"drag", "s^2", true, 800, 2, 0.8, 0.7739, 0.8244, {}, {}, {}, false, true};
  return study;
}

TEST(CoverageText, HasALinePerParameterAndPerScenario) {
  const std::vector<CoverageStudy> studies = {ExampleStudy()};
  EXPECT_EQ(CoverageText(studies),
            "scenario  parameter  coverage  [95 %]          rms error        error/bound  std error/error  no interval "
            " verdict\n"
            "breeze    inertia       0.949  [0.933, 0.962]  1.56e-06 kg m^2         1.03             0.99            2 "
            " pass\n"
            "breeze    drag          0.800  [0.774, 0.824]  -                          -                -            2 "
            " coverage\n"
            "\n"
            "scenario  recordings  converged  no fit  misses  what it is\n"
            "breeze          1000        998       1       1  a window left open\n");
}

TEST(CoverageText, NamesTheViolatedPartOfTheRule) {
  CoverageStudy study = ExampleStudy();
  study.rows[0].precise = false;
  study.rows[1].precise = false;
  const std::string text = CoverageText(std::vector{study});
  EXPECT_THAT(text, AllOf(HasSubstr("2  error\n"), HasSubstr("2  coverage, error\n"), Not(HasSubstr("pass"))));
}

TEST(CoverageMarkdown, ContainsTheCommandTheRulesAndTheSameNumbers) {
  CoverageStudy lax = ExampleStudy();
  lax.scenario.name = "storm";
  lax.scenario.rule.highest = 1;
  const std::string text = CoverageMarkdown(std::vector{ExampleStudy(), lax}, "coverage_study --scenario breeze,storm");
  EXPECT_THAT(text, StartsWith("# "));
  EXPECT_THAT(text, HasSubstr("```sh\ncoverage_study --scenario breeze,storm\n```\n"));
  EXPECT_THAT(text, HasSubstr("its coverage overlaps [0.93, 0.97], [0.93, 1.00] in `storm`, [0.94, 0.99] where the"));
  EXPECT_THAT(text, HasSubstr("| scenario | parameter | coverage | [95 %] | rms error | error/bound |"));
  EXPECT_THAT(text, HasSubstr("|\n| --- | --- | ---: | --- | --- | ---: | ---: | ---: | --- |\n"));
  EXPECT_THAT(text,
              HasSubstr("\n| storm | inertia | 0.949 | [0.933, 0.962] | 1.56e-06 kg m^2 | 1.03 | 0.99 | 2 | pass |\n"));
  EXPECT_THAT(text, HasSubstr("\n| breeze | 1000 | 998 | 1 | 1 | a window left open |\n"));
}

TEST(CoverageScenarioList, ListsNameAndDescriptionOfEachScenario) {
  CoverageScenario quiet;
  quiet.name = "quiet";
  quiet.description = "no noise";
  EXPECT_EQ(CoverageScenarioList(std::vector{quiet}), "scenario  what it is\nquiet     no noise\n");
}

}  // namespace
}  // namespace pendulum::coverage_text_test
