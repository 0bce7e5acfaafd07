// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/rig_flags.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/request/run_flags.h"

namespace pendulum::rig_flags_test {
namespace {

using testing::HasSubstr;

const RigKey& KeyOf(std::string_view flag) { return *std::ranges::find(RigKeys(), flag, &RigKey::flag); }

RigValue ValueOf(const std::string& text, std::string_view flag) {
  const auto value = ParseRigValue("--" + std::string(flag), text, KeyOf(flag));
  EXPECT_TRUE(value) << (value ? "" : value.error().message());
  return value.value_or(RigValue{-1, -1});
}

std::string Refusal(const std::string& text, std::string_view flag) {
  const auto value = ParseRigValue("--" + std::string(flag), text, KeyOf(flag));
  EXPECT_FALSE(value);
  return value ? "" : value.error().message();
}

TEST(ParseRigValue, ConvertsUnits) {
  EXPECT_DOUBLE_EQ(ValueOf("380g", "bob_mass").value, 0.38);
  EXPECT_DOUBLE_EQ(ValueOf("0.38", "bob_mass").value, 0.38);
  EXPECT_DOUBLE_EQ(ValueOf("380000 mg", "bob_mass").value, 0.38);
  EXPECT_DOUBLE_EQ(ValueOf("2lb", "mass").value, 0.90718474);
  EXPECT_DOUBLE_EQ(ValueOf("43cm", "rod_length").value, 0.43);
  EXPECT_EQ(ValueOf("47.5cm", "rod_length").value, 0.475);
  EXPECT_EQ(ValueOf("47,5cm", "rod_length").value, 0.475);
  EXPECT_EQ(ValueOf("0,475m", "rod_length").value, 0.475);
  EXPECT_THAT(Refusal("1,500g", "bob_mass"), HasSubstr("must be a number with a unit"));  // 1.5 g or 1500 g
  EXPECT_DOUBLE_EQ(ValueOf("430 mm", "rod_length").value, 0.43);
  EXPECT_DOUBLE_EQ(ValueOf("10in", "rod_length").value, 0.254);
  EXPECT_DOUBLE_EQ(ValueOf("1800mNm", "gravity_torque").value, 1.8);
  EXPECT_DOUBLE_EQ(ValueOf("790 kg cm²", "inertia").value, 0.079);
  EXPECT_DOUBLE_EQ(ValueOf("0.079kg*m^2", "inertia").value, 0.079);
  EXPECT_DOUBLE_EQ(ValueOf("9.81m/s2", "g").value, 9.81);
}

TEST(ParseRigValue, ReadsStandardDeviations) {
  for (const char* const text : {"380+-1g", "380 +- 1 g", "380±1g", "380+/-1g"}) {
    EXPECT_DOUBLE_EQ(ValueOf(text, "bob_mass").value, 0.38) << text;
    EXPECT_DOUBLE_EQ(ValueOf(text, "bob_mass").std_dev, 0.001) << text;
  }
}

TEST(RigValuesOf, CallsOnlyAStatedZeroExact) {
  std::vector<std::string> texts(RigKeys().size());
  std::vector<Warning> warnings;
  texts[0] = "380+-0g";
  EXPECT_EQ(RigValuesOf(texts, warnings).value()["bob_mass"]["std_dev"], 0);
  texts[0] = "380g";
  EXPECT_EQ(RigValuesOf(texts, warnings).value()["bob_mass"], 0.38);
}

TEST(ParseRigValue, RefusesOtherTexts) {
  EXPECT_EQ(
      Refusal("380 cm", "bob_mass"),
      "--bob_mass is '380 cm'; it must be a number with a unit, such as 380g or 380+-1g; the units are kg, g, mg, "
      "lb, oz");
  EXPECT_THAT(Refusal("heavy", "bob_mass"), HasSubstr("--bob_mass is 'heavy'"));
  EXPECT_THAT(Refusal("43+-cm", "rod_length"), HasSubstr("the units are m, cm, mm, inch, in, ft"));
  EXPECT_THAT(Refusal("nan", "rod_length"), HasSubstr("it must be a number with a unit"));
}

TEST(MakeIdentifyOptions, TakesTheValuesOfTheRig) {
  RunFlags flags;
  for (const RunFlag& flag : RunFlagTable()) {
    if (flag.name == "bob_mass") *std::get<std::string*>(flag.In(flags)) = "0.38";
    if (flag.name == "g") *std::get<std::string*>(flag.In(flags)) = "9.81+-0.01";
  }
  const auto options = MakeIdentifyOptions(flags);
  ASSERT_TRUE(options) << options.error().message();
  EXPECT_EQ(options->rig_values,
            nlohmann::ordered_json::parse(R"({"bob_mass": 0.38, "gravity": {"value": 9.81, "std_dev": 0.01}})"));
  ASSERT_EQ(options->notes.size(), 1);
  EXPECT_EQ(options->notes[0].code, "rig_unit_assumed");
  EXPECT_EQ(
      MessageText(options->notes[0]),
      "values without a unit were taken in SI units: --bob_mass 0.38 kg; write the unit after the number, such as "
      "380g or 43cm");
}

/// The period does not depend on the mass, so no swing shows that it is in g.
TEST(MakeIdentifyOptions, AsksForTheUnitOfMassesTooHeavyInKg) {
  const auto options_of = [](const std::string& bob, const std::string& rod) {
    RunFlags flags;
    for (const RunFlag& flag : RunFlagTable()) {
      if (flag.name == "bob_mass") *std::get<std::string*>(flag.In(flags)) = bob;
      if (flag.name == "rod_mass") *std::get<std::string*>(flag.In(flags)) = rod;
      if (flag.name == "rod_length") *std::get<std::string*>(flag.In(flags)) = "0.385";
    }
    return MakeIdentifyOptions(flags);
  };
  const auto refused = options_of("412", "88+-1");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("--bob_mass 412, --rod_mass 88+-1 have no unit"));
  EXPECT_THAT(refused.error().try_flags, testing::ElementsAre("--bob_mass 412g", "--rod_mass 88+-1g"));
  EXPECT_TRUE(options_of("412kg", "88g").has_value());
  EXPECT_TRUE(options_of("9", "0.088").has_value());
}

// A new key of the rig gets its flag.
TEST(RunFlagTable, HasAFlagForEachKeyOfTheRig) {
  for (const RigKey& key : RigKeys()) {
    EXPECT_EQ(std::ranges::count(RunFlagTable(), key.flag, &RunFlag::name), 1) << key.name;
  }
}

}  // namespace
}  // namespace pendulum::rig_flags_test
