// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig_check.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/base/warning_matchers.h"

namespace pendulum::rig_check_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Rig RigOf(const std::string& text) {
  const Result<Rig> rig = ParseRig(text, "rig.json");
  EXPECT_TRUE(rig.has_value()) << (rig ? "" : rig.error().message());
  return rig.value_or(Rig());
}

/// The textbook's rig with other values of bob_mass, rod_mass, rod_length and gravity.
Rig Textbook(const std::string& bob, const std::string& rod, const std::string& length, const std::string& g = "9.81") {
  return RigOf(R"({"bob_mass": )" + bob + R"(, "rod_mass": )" + rod + R"(, "rod_length": )" + length +
               R"(, "gravity": )" + g + "}");
}

/// G/I of the textbook's rig, with the inertia that its authors measured: 1.803 N m / 0.079 kg m².
constexpr double kSeen = 1.803 / 0.079;

auto Is(const std::string& code, const std::string& text) { return AllOf(CodeIs(code), MessageIs(HasSubstr(text))); }

std::vector<Warning> Implausible(const Rig& rig) {
  std::vector<Warning> warnings = QuestionRig(rig);
  std::erase_if(warnings, [](const Warning& warning) { return warning.code != "rig_implausible"; });
  return warnings;
}

std::string Refusal(const Rig& rig, double gravity_over_inertia) {
  const auto compared = CompareRigWithSwing(rig, gravity_over_inertia);
  EXPECT_FALSE(compared.has_value());
  if (compared) return "";
  EXPECT_EQ(compared.error().code, StatusCode::kDataLoss);
  return compared.error().message();
}

std::vector<Warning> Compared(const Rig& rig, double gravity_over_inertia) {
  const auto compared = CompareRigWithSwing(rig, gravity_over_inertia);
  EXPECT_TRUE(compared.has_value()) << (compared ? "" : compared.error().message());
  return compared.value_or(std::vector<Warning>());
}

TEST(QuestionRig, AcceptsTheTextbookRig) {
  EXPECT_THAT(Implausible(Textbook("0.380", "0.095", "0.43")), IsEmpty());
  EXPECT_THAT(Implausible(RigOf(R"({"gravity_torque": 1.803, "inertia": 0.079})")), IsEmpty());
  EXPECT_THAT(Implausible(RigOf(R"({"stiffness": 0.02})")), IsEmpty());
  // Foucault's pendulum in the Panthéon: 28 kg on 67 m. Only the length is unusual.
  EXPECT_THAT(Implausible(RigOf(R"({"mass": 28, "length": 67, "gravity": 9.81})")),
              ElementsAre(Is("rig_implausible", R"("length" is 67 m)")));
}

TEST(QuestionRig, AsksForMassesInGrams) {
  EXPECT_THAT(Implausible(Textbook("380", "95", "0.43")),
              ElementsAre(Is("rig_implausible", R"(the rig: "bob_mass" is 380 kg: in g? Write 0.38)"),
                          Is("rig_implausible", R"(the rig: "rod_mass" is 95 kg: in g? Write 0.095)")));
  // 40 g as 40 kg on a rod of half a metre.
  EXPECT_THAT(Implausible(Textbook("40", "0.01", "0.43")),
              ElementsAre(Is("rig_implausible", R"("bob_mass" is 40 kg: in g? Write 0.04)")));
}

TEST(QuestionRig, AsksForLengthsAndGravityInOtherUnits) {
  EXPECT_THAT(Implausible(Textbook("0.38", "0.095", "43")),
              ElementsAre(Is("rig_implausible", R"("rod_length" is 43 m: in cm? Write 0.43)")));
  EXPECT_THAT(Implausible(RigOf(R"({"length": 1200})")),
              ElementsAre(Is("rig_implausible", R"("length" is 1200 m: in mm? Write 1.2)")));
  EXPECT_THAT(Implausible(Textbook("0.38", "0.095", "0.43", "981")),
              ElementsAre(Is("rig_implausible", R"("gravity" is 981 m/s^2: in cm/s^2? Write 9.81)")));
  EXPECT_THAT(Implausible(Textbook("0.38", "0.095", "0.43", "1.62")),
              ElementsAre(Is("rig_implausible", R"("gravity" is 1.62 m/s^2, which is not the Earth's)")));
}

TEST(QuestionRig, SaysWhatNominalValuesAdd) {
  // By hand: dG/G for 1 g in M, 1 % in m, 1 mm in l, and 0.015 m/s² in g: hypot(1e-3, 0.475e-3) / 0.4275, 1 / 430, 15 /
  // 9810.
  EXPECT_THAT(QuestionRig(Textbook("0.380", "0.095", "0.43")),
              ElementsAre(Is("rig_errors_assumed",
                             "scales ±1 g, a ruler ±1 mm, gravity ±0.015; all values of the rig "
                             "together add a systematic error of 0.38 % to inertia")));
  // 1 mm of 420 mm is 0.24 % of g.
  EXPECT_THAT(QuestionRig(RigOf(R"({"length": 0.42})")),
              ElementsAre(Is("rig_errors_assumed", "add a systematic error of 0.24 % to g")));
  EXPECT_THAT(QuestionRig(RigOf(R"({"stiffness": 0.02})")),
              ElementsAre(Is("rig_errors_assumed",
                             "a stiffness ±1 %; all values of the rig together add a systematic "
                             "error of 1 %")));
}

TEST(QuestionRig, SaysWhichValuesAreNominalBesideStatedOnes) {
  EXPECT_THAT(QuestionRig(RigOf(R"({"mass": {"value": 0.475, "std_dev": 0.0001}, "center_of_mass": 0.387,
                                    "gravity": {"value": 9.81, "std_dev": 0}})")),
              ElementsAre(Is("rig_errors_assumed", R"("center_of_mass" has no standard deviation)")));
}

TEST(QuestionRig, CallsARigExactOnlyIfItSaysSo) {
  EXPECT_THAT(QuestionRig(RigOf(R"({"gravity_torque": {"value": 1.8, "std_dev": 0}})")),
              ElementsAre(Is("rig_exact", "count as exact")));
  EXPECT_THAT(QuestionRig(RigOf(R"({"gravity_torque": {"value": 1.8, "std_dev": 0.01}})")), IsEmpty());
  EXPECT_THAT(QuestionRig(Rig{{1.8, 0}, {}, {}}), IsEmpty());  // not from a file
}

TEST(CompareRigWithSwing, AcceptsTheTextbookRig) {
  EXPECT_THAT(Compared(Textbook("0.380", "0.095", "0.43"), kSeen), IsEmpty());
  // Masses cancel in G/I, so a wrong unit of all masses does not show here.
  EXPECT_THAT(Compared(Textbook("380", "95", "0.43"), kSeen), IsEmpty());
}

TEST(CompareRigWithSwing, RefusesALengthInAnotherUnit) {
  EXPECT_THAT(Refusal(Textbook("0.38", "0.095", "43"), kSeen),
              AllOf(HasSubstr("rig.json: the rig gives G/I = 0.237 1/s^2, a period of 12.9 s"),
                    HasSubstr("the recording shows 22.8 1/s^2, a period of 1.32 s"),
                    HasSubstr(R"("rod_length" is 43 m: in cm? Write 0.43)")));
  EXPECT_THAT(Refusal(Textbook("0.38", "0.095", "430"), kSeen),
              HasSubstr(R"("rod_length" is 430 m: in mm? Write 0.43)"));
  EXPECT_THAT(Refusal(Textbook("0.38", "0.095", "17"), kSeen),
              HasSubstr(R"("rod_length" is 17 m: in inch? Write 0.43)"));
  EXPECT_THAT(Refusal(Textbook("0.38", "0.095", "0.43", "981"), kSeen),
              HasSubstr(R"("gravity" is 981 m/s^2: in cm/s^2?)"));
}

TEST(CompareRigWithSwing, RefusesAnInertiaInAnotherUnit) {
  EXPECT_THAT(Refusal(RigOf(R"({"gravity_torque": 1.803, "inertia": 790})"), kSeen),
              HasSubstr(R"("inertia" is 790 kg m^2: in kg cm^2? Write 0.079)"));
  EXPECT_THAT(Refusal(RigOf(R"({"gravity_torque": 1803, "inertia": 0.079})"), kSeen),
              HasSubstr(R"("gravity_torque" is 1803 N m: in mN m? Write 1.803)"));
  EXPECT_THAT(Refusal(RigOf(R"({"stiffness": 0.02, "inertia": 16.2})"), 12.33),
              AllOf(HasSubstr("k/I"), HasSubstr(R"("inertia" is 16.2 kg m^2: in kg cm^2? Write 0.00162)")));
}

TEST(CompareRigWithSwing, RefusesACenterOfMassThatNoInertiaAllows) {
  // I >= m d², so G/I <= g/d: 9.81 / 39 = 0.25.
  EXPECT_THAT(Refusal(RigOf(R"({"mass": 0.475, "center_of_mass": 38.7, "gravity": 9.81})"), kSeen),
              HasSubstr(R"("center_of_mass" is 38.7 m: in cm? Write 0.387)"));
  EXPECT_THAT(Compared(RigOf(R"({"mass": 0.475, "center_of_mass": 0.387, "gravity": 9.81})"), kSeen), IsEmpty());
  // A wheel on its axis, nearly balanced: its inertia may be as large as it likes.
  EXPECT_THAT(Compared(RigOf(R"({"mass": 5, "center_of_mass": 0.001, "gravity": 9.81})"), 0.5), IsEmpty());
}

TEST(CompareRigWithSwing, RefusesALengthWithoutGravityOnlyIfNoPlanetFits) {
  EXPECT_THAT(Refusal(RigOf(R"({"length": 42})"), 9.81 / 0.42), HasSubstr(R"("length" is 42 m: in cm? Write 0.42)"));
  EXPECT_THAT(Refusal(RigOf(R"({"length": 420})"), 9.81 / 0.42), HasSubstr(R"("length" is 420 m: in mm? Write 0.42)"));
  EXPECT_THAT(Compared(RigOf(R"({"length": 0.42})"), 9.81 / 0.42), IsEmpty());
  EXPECT_THAT(Compared(RigOf(R"({"length": 0.42})"), 1.62 / 0.42),
              ElementsAre(Is("rig_implausible", "length 0.42 m gives g = 1.62 m/s^2, which is not the Earth's")));
}

TEST(CompareRigWithSwing, AsksForTheKeyOfAnInertiaOffByAFactor) {
  // Half the length as the lever of the bob: a quarter of the inertia and half the torque.
  EXPECT_THAT(Compared(Textbook("0.38", "0.095", "0.215"), kSeen),
              ElementsAre(Is("inertia_differs_from_rig", "that the rig's rod_length and the masses give")));
  EXPECT_THAT(Compared(RigOf(R"({"gravity_torque": 1.803, "inertia": 0.158})"), kSeen),
              ElementsAre(Is("inertia_differs_from_rig",
                             "the fitted inertia is 0.5 times the one that the rig's inertia gives")));
}

TEST(CompareRigWithSwing, BlamesTheTimesIfNoUnitExplainsIt) {
  // Seconds taken for milliseconds.
  EXPECT_THAT(Refusal(Textbook("0.380", "0.095", "0.43"), 1e6 * kSeen),
              AllOf(HasSubstr("correct the unit of the times"), HasSubstr("correct the rig (SI units"),
                    Not(HasSubstr("Write"))));
}

}  // namespace
}  // namespace pendulum::rig_check_test
