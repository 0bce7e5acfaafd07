// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig_values.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::rig_values_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kRodAndBob = R"({"bob_mass": 0.4, "rod_mass": {"value": 0.1, "std_dev": 0},
                               "rod_length": {"value": 0.5, "std_dev": 0}, "gravity": {"value": 9.8, "std_dev": 0}})";

TEST(ParseRigWith, ReplacesValuesOfTheText) {
  std::vector<Warning> warnings;
  const auto rig = ParseRigWith({{"bob_mass", {{"value", 0.3}, {"std_dev", 0.001}}}}, kRodAndBob, "rig.json", warnings);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_THAT(warnings, IsEmpty());
  // G = (M + m/2) g l
  EXPECT_NEAR(rig->gravity_torque.value, 0.35 * 9.8 * 0.5, 1e-12);
  EXPECT_NEAR(rig->gravity_torque.std_dev, 0.001 * 9.8 * 0.5, 1e-12);
  EXPECT_EQ(rig->source["bob_mass"]["value"], 0.3);
}

TEST(ParseRigWith, AssumesGravityIfItIsNeeded) {
  std::vector<Warning> warnings;
  const auto rig = ParseRigWith({}, R"({"mass": 0.5, "center_of_mass": 0.2})", "rig.json", warnings);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->gravity_torque.value, 0.5 * 0.2 * 9.806, 1e-12);
  ASSERT_EQ(warnings.size(), 1);
  EXPECT_EQ(warnings[0].code, "gravity_assumed");
}

TEST(ParseRigWith, RefusesAWrongText) {
  std::vector<Warning> warnings;
  EXPECT_THAT(ParseRigWith({{"bob_mass", 0.3}}, "{", "rig.json", warnings).error().message(),
              testing::StartsWith("rig.json:"));
  EXPECT_THAT(ParseRigWith({{"mass", 0.3}}, kRodAndBob, "rig.json", warnings).error().message(),
              testing::HasSubstr("belong to different descriptions"));
}

TEST(RigOfValues, AssumesGravityIfItIsNeeded) {
  std::vector<Warning> warnings;
  const Json values = {{"bob_mass", {{"value", 0.4}, {"std_dev", 0}}},
                       {"rod_mass", {{"value", 0.1}, {"std_dev", 0}}},
                       {"rod_length", {{"value", 0.5}, {"std_dev", 0}}}};
  const auto rig = RigOfValues(values, warnings);
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->gravity_torque.value, 0.45 * 9.806 * 0.5, 1e-12);
  EXPECT_NEAR(rig->gravity_torque.std_dev, 0.45 * 0.015 * 0.5, 1e-12);
  ASSERT_EQ(warnings.size(), 1);
  EXPECT_EQ(warnings[0].code, "gravity_assumed");
  EXPECT_EQ(MessageText(warnings[0]),
            "g was taken as 9.806 ± 0.015 m/s^2, as at sea level; give the local value with --g");
}

TEST(RigOfValues, NeedsNoGravityBesideATorque) {
  std::vector<Warning> warnings;
  EXPECT_EQ(RigOfValues({{"gravity_torque", 1.8}}, warnings)->gravity_torque.value, 1.8);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(RigOfValues, NamesAMissingValue) {
  std::vector<Warning> warnings;
  const auto rig = RigOfValues({{"bob_mass", 0.4}, {"rod_length", 0.5}}, warnings);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, StatusCode::kInvalidArgument);
  EXPECT_EQ(rig.error().message(),
            "the rig given by flags: --rod_mass is missing beside --bob_mass; add it, 0 for a string");
  EXPECT_THAT(rig.error().try_flags, ElementsAre("--rod_mass 0g"));
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(RigOfValues, NamesAllMissingValuesAtOnce) {
  std::vector<Warning> warnings;
  EXPECT_EQ(RigOfValues({{"bob_mass", 0.4}}, warnings).error().message(),
            "the rig given by flags: --rod_mass, --rod_length are missing beside --bob_mass; add them");
}

/// Whoever gives a length may want to measure g.
TEST(RigOfValues, AssumesNoGravityBesideALengthOrAnInertia) {
  for (const Json& values : {Json{{"length", 0.42}, {"mass", 0.1}}, Json{{"inertia", 0.079}, {"mass", 0.475}}}) {
    std::vector<Warning> warnings;
    EXPECT_FALSE(RigOfValues(values, warnings)->gravity);
    EXPECT_THAT(warnings, IsEmpty());
  }
}

TEST(OverrideWarning, NamesTheFlags) {
  EXPECT_EQ(MessageText(OverrideWarning({{"gravity", 9.8}, {"bob_mass", 0.4}})),
            "the values of the rig file were replaced by --bob_mass, --g");
}

}  // namespace
}  // namespace pendulum::rig_values_test
