// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/flag_values.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/friction/viscous.h"

namespace pendulum::flag_values_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NearestName, FindsTheIntendedName) {
  constexpr std::array<std::string_view, 3> kNames = {"model", "noise", "from"};
  EXPECT_EQ(NearestName("modle", kNames), "model");
  EXPECT_EQ(NearestName("form", kNames), "from");
  EXPECT_EQ(NearestName("temperature", kNames), "");
  constexpr std::array<std::string_view, 2> kNear = {"lose", "noise"};  // two edits away, and one swap
  EXPECT_EQ(NearestName("niose", kNear), "noise");
}

TEST(ParseNumber, NamesFlagValueAndMeaning) {
  EXPECT_EQ(ParseNumber("--from", "-1.5e-3", "a time"), -0.0015);
  for (const char* wrong : {"", "1,5", "1 s", "nan", "inf", "1e999", "+1"}) {
    const auto number = ParseNumber("--from", wrong, "a time in seconds");
    ASSERT_FALSE(number) << wrong;
    EXPECT_EQ(number.error().message(), "--from is '" + std::string(wrong) + "'; it must be a time in seconds");
  }
}

constexpr ParameterInfo kSettable[] = {kInertia, kViscous, kZeroAngle};

TEST(ParseSettings, ReadsNamesAndValues) {
  EXPECT_TRUE(ParseSettings("--fix", "", "viscous", kSettable)->empty());
  const ParameterValues expected = {{"inertia", 0.08}, {"zero_angle", -1e-3}};
  EXPECT_EQ(ParseSettings("--fix", "zero_angle=-1e-3,inertia=0.08", "viscous", kSettable), expected);
}

TEST(ParseSettings, AcceptsAFormerName) {
  constexpr ParameterInfo kOfAnEncoder[] = {kInertia, kHysteresis};
  const ParameterValues expected = {{"hysteresis", 0.001}};
  EXPECT_EQ(ParseSettings("--fix", "edge_lag=0.001", "viscous", kOfAnEncoder), expected);
  EXPECT_FALSE(ParseSettings("--fix", "edge_lag=0.001,hysteresis=0.002", "viscous", kOfAnEncoder));
}

TEST(ParseSettings, NamesTheFlagAndTheFault) {
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
    EXPECT_EQ(settings.error().message(), message);
  }
}

TEST(ParseRanges, AcceptsAMissingBound) {
  EXPECT_TRUE(ParseRanges("--bounds", "", "viscous", kSettable)->empty());
  const ParameterRanges ranges =
      ParseRanges("--bounds", "inertia=0.07:0.09,viscous=:1e-2,zero_angle=-0.1:", "viscous", kSettable).value();
  ASSERT_EQ(ranges.size(), 3);
  EXPECT_EQ(ranges.at("inertia").lower, 0.07);
  EXPECT_EQ(ranges.at("inertia").upper, 0.09);
  EXPECT_EQ(ranges.at("viscous").lower, -kUnbounded);
  EXPECT_EQ(ranges.at("viscous").upper, 0.01);
  EXPECT_EQ(ranges.at("zero_angle").lower, -0.1);
  EXPECT_EQ(ranges.at("zero_angle").upper, kUnbounded);
}

TEST(ParseRanges, NamesTheFlagAndTheFault) {
  const std::pair<const char*, const char*> refusals[] = {
      {"coulomb=0:1",
       "--bounds: model viscous has no parameter 'coulomb'; its parameters are inertia, viscous, zero_angle"},
      {"viscous", "--bounds: 'viscous' must be name=value"},
      {"viscous=1", "--bounds: 'viscous=1' must be name=low:high"},
      {"viscous=a:1", "--bounds viscous is 'a'; it must be a number in SI units"},
      {"viscous=0:1:2", "--bounds viscous is '1:2'; it must be a number in SI units"},
      {"viscous=2:1", "--bounds: 'viscous=2:1' leaves no value; low must be below high"},
      {"viscous=1:1", "--bounds: 'viscous=1:1' leaves no value; low must be below high"},
      {"viscous=0:1,viscous=0:2", "--bounds: viscous is given twice"},
      {"viscous=0:1,", "--bounds: 'viscous=0:1,' ends with a comma"},
  };
  for (const auto& [text, message] : refusals) {
    const auto ranges = ParseRanges("--bounds", text, "viscous", kSettable);
    ASSERT_FALSE(ranges) << text;
    EXPECT_EQ(ranges.error().code, StatusCode::kInvalidArgument) << text;
    EXPECT_EQ(ranges.error().message(), message);
  }
}

TEST(ParsePriors, ReadsMeanAndStandardDeviation) {
  EXPECT_TRUE(ParsePriors("--prior", "", "viscous", kSettable)->empty());
  const ParameterPriors priors =
      ParsePriors("--prior", "inertia=0.08:1e-3,zero_angle=-0.2:0.05", "viscous", kSettable).value();
  ASSERT_EQ(priors.size(), 2);
  EXPECT_EQ(priors.at("inertia").mean, 0.08);
  EXPECT_EQ(priors.at("inertia").std_dev, 0.001);
  EXPECT_EQ(priors.at("zero_angle").mean, -0.2);
  EXPECT_EQ(priors.at("zero_angle").std_dev, 0.05);
}

TEST(ParsePriors, NamesTheFlagAndTheFault) {
  const std::pair<const char*, const char*> refusals[] = {
      {"coulomb=1:1",
       "--prior: model viscous has no parameter 'coulomb'; its parameters are inertia, viscous, zero_angle"},
      {"viscous=1", "--prior: 'viscous=1' must be name=mean:std_dev"},
      {"viscous=:1", "--prior viscous is ''; it must be a number in SI units"},
      {"viscous=-1:1", "--prior: viscous is -1; it must be at least 0"},
      {"viscous=1:", "--prior viscous is ''; it must be a standard deviation in SI units"},
      {"viscous=1:0",
       "--prior: the standard deviation of viscous is 0; it must be positive (use --fix to hold a parameter)"},
      {"viscous=1:-2",
       "--prior: the standard deviation of viscous is -2; it must be positive (use --fix to hold a parameter)"},
      {"viscous=1:1,viscous=2:1", "--prior: viscous is given twice"},
  };
  for (const auto& [text, message] : refusals) {
    const auto priors = ParsePriors("--prior", text, "viscous", kSettable);
    ASSERT_FALSE(priors) << text;
    EXPECT_EQ(priors.error().code, StatusCode::kInvalidArgument) << text;
    EXPECT_EQ(priors.error().message(), message);
  }
}

TEST(Split, GivesThePartsBetweenSeparators) {
  EXPECT_THAT(Split("", ','), IsEmpty());
  EXPECT_THAT(Split("a", ','), ElementsAre("a"));
  EXPECT_THAT(Split("a,b c,d", ','), ElementsAre("a", "b c", "d"));
  EXPECT_THAT(Split(",a,,b", ','), ElementsAre("", "a", "", "b"));
}

}  // namespace
}  // namespace pendulum::flag_values_test
