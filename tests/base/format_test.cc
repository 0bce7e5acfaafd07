// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/format.h"

#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace pendulum {
namespace {

TEST(NumberText, RoundsToSignificantDigits) {
  EXPECT_EQ(NumberText(0.0123456, 2), "0.012");
  EXPECT_EQ(NumberText(99.6, 2), "1e+02");
  EXPECT_EQ(NumberText(-3.0, 6), "-3");
}

TEST(NumberText, IsTheShortestTextThatReadsBack) {
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(-1e300), "-1e+300");
  for (const double value : {1.0 / 3, 5e-324, std::numeric_limits<double>::max(), -2.2250738585072014e-308}) {
    EXPECT_EQ(std::strtod(NumberText(value).c_str(), nullptr), value);
  }
}

struct Named {
  std::string name;
};

TEST(NameList, JoinsNamesForASentence) {
  EXPECT_EQ(NameList(std::vector<Named>{}), "");
  EXPECT_EQ(NameList(std::vector<Named>{{"inertia"}}), "inertia");
  EXPECT_EQ(NameList(std::vector<Named>{{"inertia"}, {"viscous"}, {"zero_angle"}}), "inertia, viscous, zero_angle");
}

}  // namespace
}  // namespace pendulum
