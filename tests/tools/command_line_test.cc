// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/flags.h"

namespace pendulum::command_line_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<FlagInfo> kFlags = {{"data", "Recording."},
                                      {"residuals", "Residuals."},
                                      {"from", "Start, s.", "double"},
                                      {"count", "How many.", "int32"},
                                      {"clock_scale", "Factor.", "double"},
                                      {"help", "Print this text.", "bool"},
                                      {"datum", "A library's.", "string", false}};

std::string Refusal(const std::vector<std::string>& arguments) {
  const auto positional = PositionalArguments(arguments, kFlags);
  if (positional) return "";
  EXPECT_EQ(positional.error().code, StatusCode::kInvalidArgument);
  return positional.error().message();
}

std::vector<std::string> Positional(const std::vector<std::string>& arguments) {
  return PositionalArguments(arguments, kFlags).value_or(std::vector<std::string>{"refused"});
}

TEST(PositionalArguments, FollowsGflagsGrammar) {
  EXPECT_THAT(Positional({"--data", "a.csv", "-from=1.5", "--help", "--nohelp", "--clock-scale", "1"}), IsEmpty());
  EXPECT_THAT(Positional({"a.csv", "--data=x=y", "-", "--", "--data"}), ElementsAre("a.csv", "-", "--data"));
}

TEST(PositionalArguments, AcceptsADashedValueAsGflagsDoes) {
  EXPECT_THAT(Positional({"--from", "-2.5"}), IsEmpty());
  EXPECT_THAT(Positional({"--data", "--help", "x"}), ElementsAre("x"));
}

TEST(PositionalArguments, SuggestsTheNearestFlagOfTheTool) {
  EXPECT_EQ(Refusal({"--dat", "a.csv"}), "--dat is not a flag of this tool; did you mean --data?");
  EXPECT_EQ(Refusal({"-residual=x"}), "--residual is not a flag of this tool; did you mean --residuals?");
  EXPECT_EQ(Refusal({"--verbose"}), "--verbose is not a flag of this tool; --help lists the flags");
  EXPECT_EQ(Refusal({"--nodata"}), "--nodata is not a flag of this tool; did you mean --data?");
}

TEST(PositionalArguments, RefusesAFlagWithoutItsValue) {
  EXPECT_EQ(Refusal({"--help", "--data"}), "--data needs a value");
  EXPECT_EQ(Refusal({"--data="}), "--data has an empty value; leave the flag out for its default");
  EXPECT_EQ(Refusal({"--data", ""}), "--data has an empty value; leave the flag out for its default");
}

TEST(PositionalArguments, RefusesARepeatedFlag) {
  EXPECT_EQ(Refusal({"--residuals", "a", "--residuals=b"}), "--residuals is given twice; leave one of them out");
  EXPECT_EQ(Refusal({"--clock-scale", "1", "x", "-clock_scale", "1"}),
            "--clock_scale is given twice; leave one of them out");
  EXPECT_EQ(Refusal({"--data", "a.csv", "--from=1", "--data", "b.csv"}),
            "--data is given twice; give all values in one flag, separated by commas: --data a.csv,b.csv");
  EXPECT_THAT(Positional({"--data", "a.csv", "--residuals", "--data", "--", "--data"}), ElementsAre("--data"));
  EXPECT_THAT(Positional({"--help", "--help"}), IsEmpty());
}

TEST(PositionalArguments, RefusesAnInvalidNumber) {
  EXPECT_EQ(Refusal({"--from", "soon"}), "--from is 'soon'; it must be a number");
  EXPECT_EQ(Refusal({"--count", "1.5"}), "--count is '1.5'; it must be an integer");
  EXPECT_EQ(Refusal({"--count", "1e2x"}), "--count is '1e2x'; it must be an integer");
}

TEST(ReplaceAliases, ReplacesOtherNamesOfFlags) {
  EXPECT_THAT(ReplaceAliases({"--models=a", "-models", "b", "-h", "--", "-h"}, true),
              ElementsAre("--model=a", "-model", "b", "--help", "--", "-h"));
  EXPECT_THAT(ReplaceAliases({"--models=a", "-h"}, false), ElementsAre("--models=a", "--help"));
}

}  // namespace
}  // namespace pendulum::command_line_test
