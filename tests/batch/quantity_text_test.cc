// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/quantity_text.h"

#include <limits>

#include <gtest/gtest.h>

namespace pendulum::quantity_text_test {
namespace {

TEST(ValueText, HasTheDecimalsOfTheStandardDeviation) {
  Distribution inertia;
  inertia.median = 0.0790123;
  inertia.std_dev = 0.00012;  // two digits, by the rule of the Particle Data Group
  EXPECT_EQ(ValueText(inertia, inertia.median), "0.07901");
  EXPECT_EQ(ValueText(inertia, 0.08), "0.08000");
}

TEST(ValueText, KeepsThreeDigitsOfTheMedianIfOneOutlierMakesTheScatterLarge) {
  Distribution coulomb;
  coulomb.median = 0.0041234;
  coulomb.std_dev = 0.5;
  EXPECT_EQ(ValueText(coulomb, coulomb.median), "0.00412");
}

TEST(ValueText, OfOneRunHasSixDigits) {
  Distribution one;
  one.median = 1.0 / 3;
  EXPECT_EQ(ValueText(one, one.median), "0.333333");
}

TEST(SpreadText, HasTwoDigits) {
  EXPECT_EQ(SpreadText(0.000204), "0.00020");
  EXPECT_EQ(SpreadText(0.0), "0");
  EXPECT_EQ(SpreadText(std::nullopt), "-");
}

TEST(RatioText, HasThreeDigits) {
  EXPECT_EQ(RatioText(1.0345), "1.03");
  EXPECT_EQ(RatioText(12.42), "12.4");
  EXPECT_EQ(RatioText(std::numeric_limits<double>::quiet_NaN()), "-");
}

}  // namespace
}  // namespace pendulum::quantity_text_test
