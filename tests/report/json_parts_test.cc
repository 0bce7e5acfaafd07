// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/json_parts.h"

#include <limits>

#include <gtest/gtest.h>

namespace pendulum::json_parts_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(NumberObject, HasNoReasonIfNothingIsMissing) {
  EXPECT_EQ(NumberObject().Set("a", 0.5).Set("b", std::optional(2.0), "unused").Set("c", Json("text")).Done().dump(),
            R"({"a":0.5,"b":2.0,"c":"text"})");
}

TEST(NumberObject, GivesEachReasonForMissingNumbersOnce) {
  NumberObject object;
  object.Set("a", kInfinity).Set("b", std::nullopt, "not measured").Set("c", std::nullopt, "lost");
  object.Set("d", std::nullopt, "not measured").Set("e", std::optional(kInfinity), "unused");
  EXPECT_EQ(object.Done().dump(),
            R"({"a":null,"b":null,"c":null,"d":null,"e":null,"reason":"a is not a finite number; not measured; lost; )"
            R"(e is not a finite number"})");
}

TEST(NumberOrNull, IsNullForNonFiniteNumbers) {
  EXPECT_EQ(NumberOrNull(0.25), Json(0.25));
  EXPECT_TRUE(NumberOrNull(std::nullopt).is_null());
  EXPECT_TRUE(NumberOrNull(kInfinity).is_null());
  EXPECT_TRUE(TextOrNull("").is_null());
}

TEST(KeyWithUnit, WritesASlashAsAnUnderscore) { EXPECT_EQ(KeyWithUnit("sigma", "rad/s"), "sigma_rad_s"); }

TEST(IntervalJson, HasNullForAMissingEnd) {
  EXPECT_EQ(IntervalJson(0.5, 2.0).dump(), "[0.5,2.0]");
  EXPECT_EQ(IntervalJson(0.5, std::nullopt).dump(), "[0.5,null]");
  EXPECT_EQ(IntervalJson(std::nullopt, 2.0).dump(), "[null,2.0]");
  EXPECT_TRUE(IntervalJson(std::nullopt, std::nullopt).is_null());
}

}  // namespace
}  // namespace pendulum::json_parts_test
