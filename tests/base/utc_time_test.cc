// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/utc_time.h"

#include <ctime>

#include <gtest/gtest.h>

namespace pendulum::utc_time_test {
namespace {

// Expected values from `date --utc --date=@SECONDS +%FT%TZ` of GNU coreutils.
TEST(UtcTimeText, MatchesTheCalendar) {
  EXPECT_EQ(UtcTimeText(0), "1970-01-01T00:00:00Z");
  EXPECT_EQ(UtcTimeText(951827696), "2000-02-29T12:34:56Z");
  EXPECT_EQ(UtcTimeText(-1), "1969-12-31T23:59:59Z");
  EXPECT_EQ(UtcTimeText(4102444799), "2099-12-31T23:59:59Z");
}

TEST(UtcTimeText, IsThePresentTimeByDefault) {
  const std::time_t before = std::time(nullptr);
  const std::string text = UtcTimeText();
  EXPECT_LE(UtcTimeText(before), text);
  EXPECT_LE(text, UtcTimeText(std::time(nullptr)));
}

}  // namespace
}  // namespace pendulum::utc_time_test
