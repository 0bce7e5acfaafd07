// SPDX-License-Identifier: Apache-2.0
#include "tools/coverage_study_options.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::coverage_study_options_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

CoverageFlags Flags(const std::string& scenario) {
  CoverageFlags flags;
  flags.scenario = scenario;
  return flags;
}

TEST(MakeCoverageStudyOptions, KeepsTheOrderOfScenarios) {
  CoverageFlags flags = Flags("moving,white_0.5");
  flags.count = 20;
  flags.seed = 7;
  flags.threads = 3;
  flags.markdown = "coverage.md";
  const auto options = MakeCoverageStudyOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  ASSERT_EQ(options->scenarios.size(), 2);
  EXPECT_EQ(options->scenarios[0].name, "moving");
  EXPECT_EQ(options->scenarios[1].name, "white_0.5");
  EXPECT_EQ(options->study.count, 20);
  EXPECT_EQ(options->study.seed, 7);
  EXPECT_EQ(options->study.threads, 3);
  EXPECT_FALSE(options->list);
  ASSERT_EQ(options->Outputs().size(), 1);
  EXPECT_EQ(options->Outputs()[0].flag, "--markdown");
  EXPECT_EQ(options->Outputs()[0].path, "coverage.md");
}

TEST(MakeCoverageStudyOptions, GivesACommandThatReproducesTheTables) {
  const auto options = MakeCoverageStudyOptions(Flags("all"));
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->command, "coverage_study --scenario all --count 1000 --seed 1");
  EXPECT_EQ(options->scenarios.size(), CoverageScenarios().size());
  EXPECT_THAT(options->Outputs(), IsEmpty());
}

TEST(MakeCoverageStudyOptions, ListsAllScenariosByDefault) {
  CoverageFlags flags;
  flags.list = true;
  flags.markdown = "coverage.md";
  const auto options = MakeCoverageStudyOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_TRUE(options->list);
  EXPECT_EQ(options->scenarios.size(), CoverageScenarios().size());
  EXPECT_THAT(options->Outputs(), IsEmpty());
}

struct Refusal {
  std::string message;
  void (*spoil)(CoverageFlags&);
};

TEST(MakeCoverageStudyOptions, RefusesWrongFlagsAndNamesThem) {
  const std::vector<Refusal> refusals = {
      {"--scenario is missing", [](CoverageFlags& f) { f.scenario.clear(); }},
      {"--scenario: there is no scenario 'storm'", [](CoverageFlags& f) { f.scenario = "storm"; }},
      {"--scenario: scenario moving is named twice", [](CoverageFlags& f) { f.scenario = "moving,moving"; }},
      {"--count is 0; it must be 1 to 1000000", [](CoverageFlags& f) { f.count = 0; }},
      {"--count is 1000001", [](CoverageFlags& f) { f.count = 1000001; }},
      {"--threads is -1; it must be 0 to 1024", [](CoverageFlags& f) { f.threads = -1; }},
      {"'stray' does not belong to a flag", [](CoverageFlags& f) { f.positional = {"stray"}; }},
  };
  for (const Refusal& refusal : refusals) {
    CoverageFlags flags = Flags("moving");
    refusal.spoil(flags);
    const auto options = MakeCoverageStudyOptions(flags);
    ASSERT_FALSE(options) << refusal.message;
    EXPECT_EQ(options.error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(options.error().message(), HasSubstr(refusal.message));
  }
}

}  // namespace
}  // namespace pendulum::coverage_study_options_test
