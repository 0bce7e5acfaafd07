// SPDX-License-Identifier: Apache-2.0
#include "tools/command_line.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/viscous.h"

namespace pendulum {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

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
  return positional.error().message;
}

std::vector<std::string> Positional(const std::vector<std::string>& arguments) {
  return PositionalArguments(arguments, kFlags).value_or(std::vector<std::string>{"refused"});
}

TEST(PositionalArguments, FollowsGflagsGrammar) {
  EXPECT_THAT(Positional({"--data", "a.csv", "-from=1.5", "--help", "--nohelp", "--clock-scale", "1"}), IsEmpty());
  EXPECT_THAT(Positional({"a.csv", "--data=x=y", "-", "--", "--data"}), ElementsAre("a.csv", "-", "--data"));
}

TEST(PositionalArguments, TakesADashedValueAsGflagsDoes) {
  EXPECT_THAT(Positional({"--from", "-2.5"}), IsEmpty());
  EXPECT_THAT(Positional({"--data", "--help", "x"}), ElementsAre("x"));
}

TEST(PositionalArguments, SuggestsTheNearestOwnFlag) {
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

TEST(PositionalArguments, RefusesANumberThatIsNone) {
  EXPECT_EQ(Refusal({"--from", "soon"}), "--from is 'soon'; it must be a number");
  EXPECT_EQ(Refusal({"--count", "1.5"}), "--count is '1.5'; it must be an integer");
  EXPECT_EQ(Refusal({"--count", "1e2x"}), "--count is '1e2x'; it must be an integer");
}

TEST(HelpText, ShowsTheToolsOwnFlagsOnly) {
  const std::string text = HelpText("Usage.\n", kFlags);
  EXPECT_THAT(text, HasSubstr("Usage.\n  --data         Recording.\n  --residuals    Residuals.\n"));
  EXPECT_THAT(text, Not(HasSubstr("datum")));
}

TEST(ParseNumber, NamesFlagValueAndMeaning) {
  EXPECT_EQ(ParseNumber("--from", "-1.5e-3", "a time"), -0.0015);
  for (const char* wrong : {"", "1,5", "1 s", "nan", "inf", "1e999", "+1"}) {
    const auto number = ParseNumber("--from", wrong, "a time in seconds");
    ASSERT_FALSE(number) << wrong;
    EXPECT_EQ(number.error().message, "--from is '" + std::string(wrong) + "'; it must be a time in seconds");
  }
}

constexpr ParameterInfo kSettable[] = {kInertia, kViscous, kZeroAngle};

TEST(ParseSettings, ReadsNamesAndValues) {
  EXPECT_TRUE(ParseSettings("--fix", "", "viscous", kSettable)->empty());
  const ParameterValues expected = {{"inertia", 0.08}, {"zero_angle", -1e-3}};
  EXPECT_EQ(ParseSettings("--fix", "zero_angle=-1e-3,inertia=0.08", "viscous", kSettable), expected);
}

TEST(ParseSettings, NamesTheFlagAndWhatIsWrong) {
  const std::pair<const char*, const char*> refusals[] = {
      {"coulomb=1", "--set: model viscous has no parameter 'coulomb'; its parameters are inertia, viscous, zero_angle"},
      {"viscous", "--set: 'viscous' must be name=value"},
      {"=1", "--set: '=1' must be name=value"},
      {"viscous=1,,inertia=2", "--set: '' must be name=value"},
      {"viscous=1,", "--set: 'viscous=1,' ends with a comma"},
      {"viscous=1kg", "--set viscous is '1kg'; it must be a number in SI units"},
      {"viscous=-1", "--set: viscous is -1; it must be at least 0"},
      {"viscous=1,viscous=2", "--set: viscous is given twice"},
  };
  for (const auto& [text, message] : refusals) {
    const auto settings = ParseSettings("--set", text, "viscous", kSettable);
    ASSERT_FALSE(settings) << text;
    EXPECT_EQ(settings.error().code, StatusCode::kInvalidArgument) << text;
    EXPECT_EQ(settings.error().message, message);
  }
}

}  // namespace
}  // namespace pendulum
