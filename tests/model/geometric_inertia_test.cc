// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/geometric_inertia.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/model/rig.h"

namespace pendulum::geometric_inertia_test {
namespace {

using testing::DoubleNear;
using testing::IsEmpty;
using testing::SizeIs;

// A rod and a bob, each value with a standard deviation, in kg, m and m/s².
constexpr double kBob = 0.38, kRod = 0.095, kLength = 0.43, kGravity = 9.81;
constexpr double kBobError = 0.002, kRodError = 0.003, kLengthError = 0.0007, kGravityError = 0.004;
constexpr double kFitted = 0.079;  // kg m²

const char* const kRodAndBob = R"({"bob_mass": {"value": 0.38, "std_dev": 0.002},
                                   "rod_mass": {"value": 0.095, "std_dev": 0.003},
                                   "rod_length": {"value": 0.43, "std_dev": 0.0007},
                                   "gravity": {"value": 9.81, "std_dev": 0.004}})";

// A step of one standard deviation has a linearization error of half the relative error of the value. The rod's mass
// enters linearly (1.6 %), its length squared (0.1 %).
constexpr double kFirstOrder = 2e-3;

Rig ParsedRig(const std::string& text) { return ParseRig(text, "rig").value(); }

std::vector<GeometricInertia> Inertias(const std::string& text) { return GeometricInertias(ParsedRig(text), kFitted); }

double Norm(const std::vector<double>& terms) {
  double sum = 0;
  for (const double term : terms) sum += term * term;
  return std::sqrt(sum);
}

void ExpectRelativelyNear(double found, double expected, double relative) {
  EXPECT_THAT(found / expected, DoubleNear(1, relative)) << found << " is not " << expected;
}

// For the published rig, m l²/3 + M l² is 0.0761 kg m² and (M + m) l² is 0.0878 kg m².
TEST(GeometricInertias, AreGivenForRodAndBobAndPointMass) {
  const std::vector<GeometricInertia> inertias = Inertias(kRodAndBob);
  ASSERT_THAT(inertias, SizeIs(2));
  EXPECT_FALSE(inertias[0].is_point_mass);
  EXPECT_TRUE(inertias[1].is_point_mass);
  EXPECT_THAT(inertias[0].value, DoubleNear(0.0761, 5e-5));
  EXPECT_THAT(inertias[0].value, DoubleNear((kRod / 3 + kBob) * kLength * kLength, 1e-15));
  EXPECT_THAT(inertias[1].value, DoubleNear(0.0878, 5e-5));
  EXPECT_THAT(inertias[1].value, DoubleNear((kRod + kBob) * kLength * kLength, 1e-15));
}

// dI = l² dM + l²/3 dm + 2 l (M + m/3) dl; for the point mass dI = l² dM + l² dm + 2 l (M + m) dl.
TEST(GeometricInertias, HaveFirstOrderErrors) {
  const std::vector<GeometricInertia> inertias = Inertias(kRodAndBob);
  const double square = kLength * kLength;
  const double own = Norm({square * kBobError, square / 3 * kRodError, 2 * kLength * (kBob + kRod / 3) * kLengthError});
  const double point = Norm({square * kBobError, square * kRodError, 2 * kLength * (kBob + kRod) * kLengthError});
  ExpectRelativelyNear(inertias[0].std_error.value(), own, kFirstOrder);
  ExpectRelativelyNear(inertias[0].std_error.value(), ParsedRig(kRodAndBob).inertia->std_dev, kFirstOrder);
  ExpectRelativelyNear(inertias[1].std_error.value(), point, kFirstOrder);
}

// The fitted inertia is I/G, which the recording determines, times G = (M + m/2) g l: d ln G = dM / (M + m/2) + dm / (2
// M + m) + dl / l + dg / g. The geometric inertia has the same errors dM, dm and dl.
TEST(GeometricInertias, ShareTheRigsErrorsWithTheFit) {
  const std::vector<GeometricInertia> inertias = Inertias(kRodAndBob);
  const double square = kLength * kLength;
  const double reduced = kBob + kRod / 2;
  const double own =
      Norm({(square - kFitted / reduced) * kBobError, (square / 3 - kFitted / (2 * reduced)) * kRodError,
            (2 * kLength * (kBob + kRod / 3) - kFitted / kLength) * kLengthError, kFitted / kGravity * kGravityError});
  const double point =
      Norm({(square - kFitted / reduced) * kBobError, (square - kFitted / (2 * reduced)) * kRodError,
            (2 * kLength * (kBob + kRod) - kFitted / kLength) * kLengthError, kFitted / kGravity * kGravityError});
  ExpectRelativelyNear(inertias[0].difference_std_error, own, 3 * kFirstOrder);
  ExpectRelativelyNear(inertias[1].difference_std_error, point, 3 * kFirstOrder);
  EXPECT_LT(inertias[0].difference_std_error, 0.7 * inertias[0].std_error.value());  // most of the error cancels
}

// With a massless rod, inertia and torque are both proportional to the bob's mass, so an error of that mass cancels.
TEST(GeometricInertias, HaveNoErrorOfDifferenceForACommonError) {
  const std::vector<GeometricInertia> inertias =
      GeometricInertias(ParsedRig(R"({"bob_mass": {"value": 0.4, "std_dev": 0.01}, "rod_mass": 0,
                    "rod_length": {"value": 0.5, "std_dev": 0}, "gravity": {"value": 9.81, "std_dev": 0}})"),
                        0.1);
  ASSERT_THAT(inertias, SizeIs(2));
  for (const GeometricInertia& inertia : inertias) {
    EXPECT_THAT(inertia.value, DoubleNear(0.1, 1e-15));
    EXPECT_THAT(inertia.std_error.value(), DoubleNear(0.25 * 0.01, 1e-12));
    EXPECT_THAT(inertia.difference_std_error, DoubleNear(0, 1e-12));
  }
}

TEST(GeometricInertias, HaveNoErrorsIfTheRigIsExact) {
  const std::vector<GeometricInertia> inertias =
      Inertias(R"({"bob_mass": {"value": 0.38, "std_dev": 0}, "rod_mass": {"value": 0.095, "std_dev": 0},
                   "rod_length": {"value": 0.43, "std_dev": 0}, "gravity": {"value": 9.81, "std_dev": 0}})");
  ASSERT_THAT(inertias, SizeIs(2));
  for (const GeometricInertia& inertia : inertias) {
    EXPECT_FALSE(inertia.std_error);
    EXPECT_EQ(inertia.difference_std_error, 0);
  }
}

// The error of gravity changes the fitted inertia but not the geometric one.
TEST(GeometricInertias, DifferByTheErrorOfGravityAlone) {
  const std::vector<GeometricInertia> inertias = Inertias(
      R"({"bob_mass": {"value": 0.38, "std_dev": 0}, "rod_mass": {"value": 0.095, "std_dev": 0},
          "rod_length": {"value": 0.43, "std_dev": 0}, "gravity": {"value": 9.81, "std_dev": 0.02}})");
  ASSERT_THAT(inertias, SizeIs(2));
  for (const GeometricInertia& inertia : inertias) {
    EXPECT_THAT(inertia.std_error.value_or(0), DoubleNear(0, 1e-15));
    ExpectRelativelyNear(inertia.difference_std_error, kFitted * 0.02 / 9.81, 1e-9);
  }
}

TEST(GeometricInertias, UseAnInertiaGivenInTheFile) {
  const std::vector<GeometricInertia> inertias = Inertias(
      R"({"gravity_torque": {"value": 1.8, "std_dev": 0.009}, "inertia": {"value": 0.08, "std_dev": 0.0003}})");
  ASSERT_THAT(inertias, SizeIs(1));
  EXPECT_FALSE(inertias[0].is_point_mass);
  EXPECT_EQ(inertias[0].value, 0.08);
  ExpectRelativelyNear(inertias[0].std_error.value(), 0.0003, 1e-9);
  ExpectRelativelyNear(inertias[0].difference_std_error, Norm({0.0003, kFitted * 0.009 / 1.8}), 1e-9);
}

// An inertia from CAD replaces the one computed from rod and bob. The point mass still uses rod and bob.
TEST(GeometricInertias, UseTheFilesInertiaBesideARodAndABob) {
  const std::vector<GeometricInertia> inertias = Inertias(
      R"({"bob_mass": {"value": 0.38, "std_dev": 0}, "rod_mass": {"value": 0.095, "std_dev": 0},
          "rod_length": {"value": 0.43, "std_dev": 0.001}, "gravity": {"value": 9.81, "std_dev": 0},
          "inertia": {"value": 0.0775, "std_dev": 0}})");
  ASSERT_THAT(inertias, SizeIs(2));
  EXPECT_EQ(inertias[0].value, 0.0775);
  EXPECT_THAT(inertias[0].std_error.value_or(0), DoubleNear(0, 1e-15));
  ExpectRelativelyNear(inertias[0].difference_std_error, kFitted * 0.001 / 0.43, 1e-9);
  EXPECT_THAT(inertias[1].value, DoubleNear(0.475 * 0.43 * 0.43, 1e-15));
}

TEST(GeometricInertias, AreEmptyIfOnlyTheTorqueIsKnown) {
  EXPECT_THAT(Inertias(R"({"gravity_torque": {"value": 1.8, "std_dev": 0.01}})"), IsEmpty());
  EXPECT_THAT(Inertias(R"({"mass": 0.475, "center_of_mass": 0.387, "gravity": 9.81})"), IsEmpty());
}

TEST(GeometricInertias, AreGivenForARigWithoutAFile) {
  Rig rig;
  rig.gravity_torque = {1.8, 0};
  EXPECT_THAT(GeometricInertias(rig, kFitted), IsEmpty());
  rig.inertia = RigValue{0.08, 0.0003};
  const std::vector<GeometricInertia> inertias = GeometricInertias(rig, kFitted);
  ASSERT_THAT(inertias, SizeIs(1));
  EXPECT_EQ(inertias[0].value, 0.08);
  EXPECT_EQ(inertias[0].std_error, 0.0003);
  EXPECT_EQ(inertias[0].difference_std_error, 0.0003);
}

// For a rig without a file, the error of the torque changes the fitted inertia as it does for a rig from a file.
TEST(GeometricInertias, ShareTheTorquesErrorWithoutAFile) {
  Rig rig;
  rig.gravity_torque = {1.8, 0.009};
  rig.inertia = RigValue{0.08, 0.0003};
  const std::vector<GeometricInertia> inertias = GeometricInertias(rig, kFitted);
  ASSERT_EQ(inertias.size(), 1);
  EXPECT_THAT(inertias[0].difference_std_error, DoubleNear(std::hypot(0.0003, kFitted * 0.009 / 1.8), 1e-9));
}

}  // namespace
}  // namespace pendulum::geometric_inertia_test
