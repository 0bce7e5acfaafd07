// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/nesting.h"

#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::nesting_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::optional<Nesting> Between(std::string_view simpler, std::string_view richer) {
  return FindNesting(*FindMotionModel(simpler), *FindMotionModel(richer));
}

// Expected counts follow from the formulas of the laws (MODEL.md eq. (2.4) to (2.8)).
TEST(FindNesting, CountsTermsAtTheirBound) {
  const auto one = Between("viscous", "coulomb");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->bounded, 1);
  EXPECT_EQ(one->free, 0);
  EXPECT_THAT(one->unidentified, IsEmpty());
  const auto two = Between("viscous", "drag");
  ASSERT_TRUE(two);
  EXPECT_EQ(two->bounded, 2);
  ASSERT_EQ(two->added.size(), 2U);
  EXPECT_EQ(two->added[0].name, "coulomb");
  EXPECT_EQ(two->added[1].name, "drag");
}

TEST(FindNesting, CountsAParameterOfEitherSignAsFree) {
  const auto nesting = Between("coulomb", "asymmetric");
  ASSERT_TRUE(nesting);
  EXPECT_EQ(nesting->bounded, 0);
  EXPECT_EQ(nesting->free, 1);
  EXPECT_THAT(nesting->unidentified, IsEmpty());
}

TEST(FindNesting, NamesTheParameterUndefinedInTheSimplerLaw) {
  const auto stribeck = Between("coulomb", "stribeck");
  ASSERT_TRUE(stribeck);
  EXPECT_THAT(stribeck->unidentified, ElementsAre("stribeck_rate"));
  EXPECT_EQ(stribeck->bounded, 1);
  const auto asymmetric = Between("viscous", "asymmetric");
  ASSERT_TRUE(asymmetric);
  EXPECT_THAT(asymmetric->unidentified, ElementsAre("asymmetry"));
  const auto dahl = Between("viscous", "dahl");
  ASSERT_TRUE(dahl);
  EXPECT_THAT(dahl->unidentified, ElementsAre("presliding_angle"));
}

// Dry friction that builds up over no angle is that of the law coulomb.
TEST(FindNesting, CountsAParameterThatActsOnlyAfterAReversal) {
  const auto nesting = Between("coulomb", "dahl");
  ASSERT_TRUE(nesting);
  EXPECT_EQ(nesting->bounded, 1);
  EXPECT_EQ(nesting->free, 0);
  EXPECT_THAT(nesting->unidentified, IsEmpty());
}

TEST(FindNesting, FindsNoNestingInItselfOrASimplerLaw) {
  EXPECT_FALSE(Between("drag", "drag"));
  EXPECT_FALSE(Between("drag", "coulomb"));
  EXPECT_FALSE(Between("drag", "stribeck"));
  EXPECT_FALSE(Between("stribeck", "drag"));
}

TEST(FindNesting, RequiresTheSameGravity) {
  EXPECT_FALSE(Between("linear", "coulomb"));
  EXPECT_FALSE(Between("linear", "viscous"));
  EXPECT_TRUE(Between("linear", "linear_coulomb"));
}

TEST(LargestNestedModel, IsTheNestedLawOfMostParameters) {
  EXPECT_EQ(LargestNestedModel(*FindMotionModel("stribeck"))->name, "coulomb");
  EXPECT_EQ(LargestNestedModel(*FindMotionModel("drag"))->name, "coulomb");
  EXPECT_EQ(LargestNestedModel(*FindMotionModel("coulomb"))->name, "viscous");
  EXPECT_FALSE(LargestNestedModel(*FindMotionModel("viscous")));
}

TEST(FindOrderedPair, GivesStictionAndCoulomb) {
  const OrderedPair order = FindOrderedPair(*FindMotionModel("stribeck"));
  const auto infos = PhysicalParameters(*FindMotionModel("stribeck"));
  EXPECT_EQ(infos.at(static_cast<std::size_t>(order.larger)).name, "stiction");
  EXPECT_EQ(infos.at(static_cast<std::size_t>(order.smaller)).name, "coulomb");
  EXPECT_LT(FindOrderedPair(*FindMotionModel("drag")).larger, 0);
}

}  // namespace
}  // namespace pendulum::nesting_test
