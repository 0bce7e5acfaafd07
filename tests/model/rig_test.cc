// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/rig.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::rig_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// The rig of "Modeling of a Simple Pendulum", Control Tutorials for MATLAB and Simulink.
constexpr auto kTextbookRig = R"({"bob_mass": 0.380, "rod_mass": 0.095, "rod_length": 0.43, "gravity": 9.81})";

Rig RigOf(const std::string& text) {
  const Result<Rig> rig = ParseRig(text, "rig.json");
  EXPECT_TRUE(rig.has_value()) << (rig ? "" : rig.error().message());
  return rig.value_or(Rig());
}

std::string FaultOf(const std::string& text) {
  const Result<Rig> rig = ParseRig(text, "rig.json");
  EXPECT_FALSE(rig.has_value()) << text;
  if (rig) return "no fault";
  EXPECT_EQ(rig.error().code, StatusCode::kDataLoss) << rig.error().message();
  EXPECT_THAT(rig.error().message(), StartsWith("rig.json:"));
  return rig.error().message();
}

TEST(ParseRig, ReproducesTheTextbookRig) {
  const Rig rig = RigOf(kTextbookRig);
  // Published: center of mass 0.387 m, therefore G = 0.475 kg · 0.387 m · 9.81 m/s^2; inertia 0.076 kg m^2.
  EXPECT_NEAR(rig.gravity_torque.value / (0.475 * 9.81), 0.387, 0.0005);
  ASSERT_TRUE(rig.inertia.has_value());
  EXPECT_NEAR(rig.inertia->value, 0.076, 0.0005);
  // Computed by hand: 0.4275 kg · 4.2183 m^2/s^2, and 0.095 · 0.1849 / 3 + 0.380 · 0.1849.
  EXPECT_NEAR(rig.gravity_torque.value, 1.80332325, 1e-12);
  EXPECT_NEAR(rig.inertia->value, 0.076117166666666667, 1e-15);
}

TEST(ParseRig, KeepsAGivenGravityTorque) {
  const Rig rig = RigOf(R"({"gravity_torque": {"value": 1.803, "std_dev": 0.002}})");
  EXPECT_EQ(rig.gravity_torque.value, 1.803);
  EXPECT_EQ(rig.gravity_torque.std_dev, 0.002);
  EXPECT_FALSE(rig.inertia.has_value());
}

TEST(ParseRig, MultipliesMassCenterOfMassAndGravity) {
  const Rig rig = RigOf(R"({"mass": {"value": 2, "std_dev": 0}, "center_of_mass": {"value": 0.5, "std_dev": 0.01},
                            "gravity": {"value": 10, "std_dev": 0}})");
  EXPECT_DOUBLE_EQ(rig.gravity_torque.value, 10);
  EXPECT_DOUBLE_EQ(rig.gravity_torque.std_dev, 0.2);  // 2 kg 10 m/s^2 0.01 m
  EXPECT_FALSE(rig.inertia.has_value());
}

TEST(ParseRig, AcceptsAMasslessRod) {
  const Rig rig = RigOf(R"({"bob_mass": 2, "rod_mass": 0, "rod_length": 0.5, "gravity": 10})");
  EXPECT_DOUBLE_EQ(rig.gravity_torque.value, 10);  // M g l
  EXPECT_DOUBLE_EQ(rig.inertia->value, 0.5);       // M l^2
}

TEST(ParseRig, PrefersTheFilesInertiaToGeometry) {
  const Rig rig = RigOf(
      R"({"bob_mass": 0.38, "rod_mass": 0.095, "rod_length": 0.43, "gravity": 9.81,
          "inertia": {"value": 0.079, "std_dev": 0.001}})");
  EXPECT_EQ(rig.inertia->value, 0.079);
  EXPECT_EQ(rig.inertia->std_dev, 0.001);
  EXPECT_EQ(RigOf(R"({"gravity_torque": 1.8, "inertia": 0.079})").inertia->value, 0.079);
}

TEST(ParseRig, TakesAStiffnessForTheTorqueOfASpring) {
  const Rig rig = RigOf(R"({"stiffness": {"value": 0.02, "std_dev": 0.001}, "inertia": 0.0016})");
  EXPECT_TRUE(rig.is_spring && rig.gives_torque);
  EXPECT_EQ(rig.gravity_torque.value, 0.02);
  EXPECT_EQ(rig.gravity_torque.std_dev, 0.001);
  EXPECT_EQ(rig.inertia->value, 0.0016);
}

TEST(ParseRig, LeavesTheTorqueOfAStringPendulumOpenWithoutItsMass) {
  for (const char* const text :
       {R"({"length": 0.42})", R"({"gravity": 9.81})", R"({"length": 0.42, "gravity": 9.81})"}) {
    const Rig rig = RigOf(text);
    EXPECT_FALSE(rig.gives_torque || rig.is_spring || rig.inertia || rig.known_inertia) << text;
    EXPECT_EQ(rig.gravity_torque.value, 1);
  }
  EXPECT_EQ(RigOf(R"({"length": 0.42})").length->value, 0.42);
}

TEST(ParseRig, TakesTheBobOfAStringPendulumForAPointMass) {
  // By hand: 0.2 kg · 9.81 m/s² · 0.5 m, and 0.2 kg · 0.25 m².
  const Rig rig = RigOf(R"({"length": {"value": 0.5, "std_dev": 0}, "gravity": {"value": 9.81, "std_dev": 0},
                            "mass": {"value": 0.2, "std_dev": 0.01}})");
  EXPECT_TRUE(rig.gives_torque);
  EXPECT_NEAR(rig.gravity_torque.value, 0.981, 1e-12);
  EXPECT_NEAR(rig.gravity_torque.std_dev, 0.04905, 1e-12);
  EXPECT_NEAR(rig.inertia->value, 0.05, 1e-15);
  const Rig without_gravity =
      RigOf(R"({"length": {"value": 0.5, "std_dev": 0.001}, "mass": {"value": 0.2, "std_dev": 0}})");
  EXPECT_FALSE(without_gravity.gives_torque);
  EXPECT_FALSE(without_gravity.inertia);
  EXPECT_NEAR(without_gravity.known_inertia->value, 0.05, 1e-15);
  EXPECT_NEAR(without_gravity.known_inertia->std_dev, 0.0002, 1e-15);  // 2 · 0.2 kg · 0.5 m · 1 mm
}

TEST(ParseRig, KnowsTheInertiaOfAPhysicalPendulum) {
  const Rig rig = RigOf(R"({"inertia": {"value": 0.079, "std_dev": 0.001}, "mass": 0.475, "gravity": 9.81})");
  EXPECT_FALSE(rig.gives_torque || rig.inertia);
  EXPECT_EQ(rig.known_inertia->value, 0.079);
  EXPECT_EQ(rig.known_inertia->std_dev, 0.001);
  EXPECT_EQ(rig.mass->value, 0.475);
}

TEST(RigKeys, AreTheKeysThatARigMayHave) {
  for (const RigKey& key : RigKeys()) {
    const Result<Rig> rig = ParseRig("{\"" + std::string(key.name) + "\": 0.5}", "rig.json");
    const std::string fault = rig ? "" : rig.error().message();
    EXPECT_THAT(fault, testing::AnyOf("", HasSubstr(" missing beside \"" + std::string(key.name) + "\""))) << key.name;
  }
}

TEST(ParseRig, KeepsTheFileForTheReport) {
  EXPECT_EQ(RigOf(R"({ "gravity_torque": {"value": 1.8},  "inertia": 1 })").source.dump(),
            R"({"gravity_torque":{"value":1.8},"inertia":1})");
}

TEST(ParseRig, PropagatesOneErrorByItsDerivative) {
  // Computed by hand: G is proportional to l, and I to l^2.
  const Rig rig = RigOf(
      R"({"bob_mass": {"value": 0.38, "std_dev": 0}, "rod_mass": {"value": 0.095, "std_dev": 0},
          "rod_length": {"value": 0.43, "std_dev": 0.001}, "gravity": {"value": 9.81, "std_dev": 0}})");
  EXPECT_NEAR(rig.gravity_torque.std_dev, 1.80332325 * 0.001 / 0.43, 1e-12);
  EXPECT_NEAR(rig.inertia->std_dev, 2 * 0.0761171666666667 * 0.001 / 0.43, 1e-15);
}

// A bare number is nominal. By hand: 1 g in M, 1 % in m, 1 mm in l, 0.015 m/s² in g.
TEST(ParseRig, GivesNominalValuesTheErrorsOfTheirTools) {
  const Rig rig = RigOf(kTextbookRig);
  const std::vector<std::pair<std::string_view, double>> expected = {{"bob_mass", 0.001 / 0.4275},
                                                                     {"rod_mass", 0.00095 / 2 / 0.4275},
                                                                     {"rod_length", 0.001 / 0.43},
                                                                     {"gravity", 0.015 / 9.81}};
  ASSERT_EQ(rig.errors.size(), expected.size());
  double variance = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(rig.errors[k].key, expected[k].first);
    EXPECT_TRUE(rig.errors[k].is_assumed);
    EXPECT_NEAR(rig.errors[k].of_torque, expected[k].second, 1e-12);
    variance += expected[k].second * expected[k].second;
  }
  EXPECT_NEAR(rig.gravity_torque.std_dev / rig.gravity_torque.value, std::sqrt(variance), 1e-12);
  EXPECT_DOUBLE_EQ(RigOf(R"({"gravity_torque": 1.8})").gravity_torque.std_dev, 0.018);  // 1 %
}

TEST(ParseRig, CountsOnlyAStatedZeroAsExact) {
  const Rig exact = RigOf(R"({"gravity_torque": {"value": 1.8, "std_dev": 0}})");
  EXPECT_EQ(exact.gravity_torque.std_dev, 0);
  EXPECT_TRUE(exact.errors.empty());
  const Rig stated = RigOf(R"({"gravity_torque": {"value": 1.8, "std_dev": 0.009}})");
  ASSERT_EQ(stated.errors.size(), 1);
  EXPECT_FALSE(stated.errors[0].is_assumed);
  EXPECT_NEAR(stated.errors[0].of_torque, 0.005, 1e-15);
}

TEST(NominalStdDev, IsThatOfAToolForThingsOfThatSize) {
  EXPECT_EQ(NominalStdDev(RigQuantity::kMass, 0.38), 0.001);
  EXPECT_EQ(NominalStdDev(RigQuantity::kMass, 0.02), 0.0002);  // nobody weighs 20 g on kitchen scales
  EXPECT_EQ(NominalStdDev(RigQuantity::kMass, 28), 0.028);
  EXPECT_EQ(NominalStdDev(RigQuantity::kMass, 0), 0);  // a rod that weighs nothing
  EXPECT_EQ(NominalStdDev(RigQuantity::kLength, 0.43), 0.001);
  EXPECT_EQ(NominalStdDev(RigQuantity::kAcceleration, 9.81), 0.015);
}

TEST(ParseRig, MatchesMonteCarloForIndependentErrors) {
  const Rig rig = RigOf(
      R"({"bob_mass": {"value": 0.38, "std_dev": 0.002}, "rod_mass": {"value": 0.095, "std_dev": 0.005},
          "rod_length": {"value": 0.43, "std_dev": 0.001}, "gravity": {"value": 9.81, "std_dev": 0.05}})");
  constexpr int kDraws = 200000;  // Determines a standard deviation to 0.16 %.
  std::mt19937_64 generator(20240611);
  std::normal_distribution<double> normal;
  double torque_sum = 0, torque_squares = 0, inertia_sum = 0, inertia_squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double bob = 0.38 + 0.002 * normal(generator), rod = 0.095 + 0.005 * normal(generator);
    const double length = 0.43 + 0.001 * normal(generator), gravity = 9.81 + 0.05 * normal(generator);
    // Computed via the center of mass and the parallel-axis theorem, unlike the code under test.
    const double center_of_mass = (bob * length + rod * length / 2) / (bob + rod);
    const double torque = (bob + rod) * gravity * center_of_mass - 1.80332325;
    const double inertia = rod * length * length / 12 + rod * std::pow(length / 2, 2) + bob * length * length - 0.0761;
    torque_sum += torque;
    torque_squares += torque * torque;
    inertia_sum += inertia;
    inertia_squares += inertia * inertia;
  }
  const auto std_dev = [](double sum, double squares) { return std::sqrt((squares - sum * sum / kDraws) / kDraws); };
  EXPECT_NEAR(rig.gravity_torque.std_dev / std_dev(torque_sum, torque_squares), 1, 0.01);
  EXPECT_NEAR(rig.inertia->std_dev / std_dev(inertia_sum, inertia_squares), 1, 0.01);
}

TEST(ParseRig, NamesAnUnknownKeyAndTheAllowedOnes) {
  EXPECT_EQ(
      FaultOf(R"({"bob_mas": 0.38, "rod_mass": 0.095, "rod_length": 0.43, "gravity": 9.81})"),
      R"(rig.json: "bob_mas" is not a key of a rig; a rig is {"bob_mass", "rod_mass", "rod_length", "gravity"} or )"
      R"({"gravity_torque"} or {"mass", "center_of_mass", "gravity"} or {"stiffness"} or {"length"}, {"gravity"} or )"
      R"(both, with optional "mass", or {"inertia"}, each with optional "inertia")");
  EXPECT_THAT(FaultOf(R"({"gravity_torque": {"value": 1, "sd": 2}})"),
              AllOf(HasSubstr(R"("sd" is not a key of "gravity_torque")"), HasSubstr(R"("std_dev")")));
  EXPECT_THAT(FaultOf("{\"a\\u001b[31m\": 1}"), HasSubstr(R"("a\x1b[31m" is not a key)"));
}

TEST(ParseRig, NamesAMissingKey) {
  EXPECT_THAT(FaultOf(R"({"bob_mass": 0.38, "rod_length": 0.43, "gravity": 9.81})"),
              HasSubstr(R"("rod_mass" is missing beside "bob_mass")"));
  EXPECT_THAT(FaultOf(R"({"mass": 0.38, "center_of_mass": 0.43})"), HasSubstr(R"("gravity" is missing)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": {"std_dev": 1}})"), HasSubstr(R"("gravity_torque" has no "value")"));
}

TEST(ParseRig, RefusesAnIncompleteDescription) {
  EXPECT_THAT(FaultOf("{}"), HasSubstr("the rig has no complete description; it must be {\"bob_mass\""));
  EXPECT_THAT(FaultOf(R"({"mass": 1})"),
              HasSubstr(R"("gravity", "center_of_mass" are missing beside "mass"; add them)"));
}

TEST(ParseRig, RefusesAMixtureOfDescriptions) {
  EXPECT_THAT(FaultOf(R"({"gravity_torque": 1.8, "bob_mass": 0.38})"),
              HasSubstr(R"("gravity_torque" and "bob_mass" belong to different descriptions)"));
  EXPECT_THAT(FaultOf(R"({"gravity": 9.81, "mass": 0.4, "rod_length": 0.43})"),
              HasSubstr(R"("mass" and "rod_length" belong to different descriptions)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": 1.8, "gravity": 9.81})"), HasSubstr("cannot be mixed"));
}

TEST(ParseRig, RefusesANonPositiveValue) {
  EXPECT_EQ(FaultOf(R"({"gravity_torque": 0})"), R"(rig.json: "gravity_torque" is 0; it must be positive)");
  EXPECT_THAT(FaultOf(R"({"gravity_torque": {"value": -1.5}})"),
              HasSubstr(R"("value" of "gravity_torque" is -1.5; it must be positive)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": 1, "inertia": 0})"), HasSubstr(R"("inertia" is 0; it must be positive)"));
  EXPECT_THAT(FaultOf(R"({"bob_mass": 1, "rod_mass": -0.1, "rod_length": 1, "gravity": 1})"),
              HasSubstr(R"("rod_mass" is -0.1; it must be 0 or more)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": {"value": 1, "std_dev": -0.1}})"),
              HasSubstr(R"("std_dev" of "gravity_torque" is -0.1; it must be 0 or more)"));
}

TEST(ParseRig, RefusesValuesThatAreNotNumbers) {
  EXPECT_EQ(FaultOf(R"({"gravity_torque": "1.8"})"),
            R"(rig.json: "gravity_torque" is "1.8"; it must be a number or {"value": number, "std_dev": number})");
  EXPECT_THAT(FaultOf(R"({"gravity_torque": null})"), HasSubstr(R"("gravity_torque" is null)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": true})"), HasSubstr(R"("gravity_torque" is true)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": [1]})"), HasSubstr(R"("gravity_torque" is an array)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": {"value": {}}})"), HasSubstr(R"("gravity_torque" is an object)"));
}

TEST(ParseRig, RefusesARepeatedKey) {
  EXPECT_THAT(FaultOf(R"({"gravity_torque": 1.8, "gravity_torque": 1.9})"),
              HasSubstr(R"(the key "gravity_torque" is given twice)"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": {"value": 1, "value": 2}})"),
              HasSubstr(R"(the key "value" is given twice)"));
}

TEST(ParseRig, AcceptsTheSameKeyInTwoObjects) {
  EXPECT_EQ(RigOf(R"({"gravity_torque": {"value": 1}, "inertia": {"value": 2}})").inertia->value, 2);
}

TEST(ParseRig, NamesLineAndColumnOfInvalidJson) {
  EXPECT_EQ(FaultOf("{\n  \"gravity_torque\": 1.8,\n}"),
            "rig.json:3:1: this is not JSON (unexpected '}'; expected string literal); correct it here");
  EXPECT_THAT(FaultOf(""), StartsWith("rig.json:1:1: this is not JSON"));
  EXPECT_THAT(FaultOf("{\"gravity_torque\": NaN}"), StartsWith("rig.json:1:20: this is not JSON"));
  EXPECT_THAT(FaultOf("{\"gravity_torque\": 1.8} 2"), StartsWith("rig.json:1:25: this is not JSON"));
  EXPECT_THAT(FaultOf("{\"\xFF\": 1}"), StartsWith("rig.json:1:3: this is not JSON"));
}

TEST(ParseRig, RefusesJsonThatIsNotAnObject) {
  EXPECT_THAT(FaultOf("[1, 2]"), HasSubstr("the rig is an array; it must be an object"));
  EXPECT_THAT(FaultOf("1.8"), HasSubstr("the rig is 1.8; it must be an object"));
}

TEST(ParseRig, RefusesNumbersBeyondADouble) {
  EXPECT_EQ(FaultOf(R"({"bob_mass": 1, "rod_mass": 1e999, "rod_length": 1, "gravity": 1})"),
            R"(rig.json: "rod_mass" is larger than a number can be (about 1e308); correct it)");
  // Each value fits in a double, but the product does not.
  EXPECT_THAT(FaultOf(R"({"mass": 1e200, "center_of_mass": 1e200, "gravity": 1})"), HasSubstr("outside 1e-30 to 1e30"));
  EXPECT_THAT(FaultOf(R"({"mass": 1e-200, "center_of_mass": 1e-200, "gravity": 1})"),
              HasSubstr("outside 1e-30 to 1e30"));
  EXPECT_THAT(FaultOf(R"({"gravity_torque": 1e-300})"), HasSubstr("outside 1e-30 to 1e30"));
}

TEST(ParseRig, RefusesATooLongTextWithoutParsingIt) {
  EXPECT_THAT(FaultOf(std::string(100000, '[')), HasSubstr("longer than 64 KiB"));
  EXPECT_THAT(FaultOf(std::string(60000, '[')), HasSubstr("this is not JSON"));
}

TEST(ReadRig, ReadsAFile) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "rig_test_read.json";
  std::ofstream(path) << "\xEF\xBB\xBF" << kTextbookRig << "\r\n";
  const Result<Rig> rig = ReadRig(path);
  ASSERT_TRUE(rig.has_value()) << rig.error().message();
  EXPECT_NEAR(rig->gravity_torque.value, 1.80332325, 1e-12);
  std::filesystem::remove(path);
}

TEST(ReadRig, ReportsAMissingFile) {
  const Result<Rig> rig = ReadRig("/nowhere/rig.json");
  ASSERT_FALSE(rig.has_value());
  EXPECT_EQ(rig.error().code, StatusCode::kNotFound);
  EXPECT_EQ(rig.error().message(), "/nowhere/rig.json: there is no such file; check the path");
}

TEST(ReadRig, RefusesADirectory) {
  const Result<Rig> rig = ReadRig(testing::TempDir());
  ASSERT_FALSE(rig.has_value());
  EXPECT_EQ(rig.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(rig.error().message(), HasSubstr("this is a directory"));
}

}  // namespace
}  // namespace pendulum::rig_test
