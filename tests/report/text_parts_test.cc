// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text_parts.h"

#include <limits>

#include <gtest/gtest.h>

namespace pendulum::text_parts_test {
namespace {

// 0.0790 ± 0.0012: the leading digits 120 keep two digits (PDG); other numbers have the same last decimal.
TEST(QuantityNumbers, RoundsAllNumbersToTheDecimalOfTheError) {
  const QuantityNumbers numbers(0.07901, 0.0012);
  EXPECT_EQ(numbers.Value(), "0.0790");
  EXPECT_EQ(numbers.Error(), "± 0.0012");
  EXPECT_EQ(numbers.Number(0.08), "0.0800");
  EXPECT_EQ(numbers.Interval(0.07, std::nullopt), "[0.0700, ?]");
  EXPECT_EQ(numbers.Interval(std::nullopt, std::nullopt), "");
  EXPECT_EQ(numbers.SecondError(0.0005), "± 0.0005");
  EXPECT_EQ(numbers.SecondError(std::nullopt), "");
}

TEST(QuantityNumbers, MultipliesEveryNumberByTheFactor) {
  const QuantityNumbers numbers(0.079, 0.0012, 10);
  EXPECT_EQ(numbers.Value(), "0.790");
  EXPECT_EQ(numbers.Error(), "± 0.012");
  EXPECT_EQ(numbers.Number(0.08), "0.800");
}

TEST(QuantityNumbers, BracketsValueAndErrorTogether) {
  const QuantityNumbers numbers(3e-6, 1.2e-7);
  EXPECT_EQ(numbers.Value() + " " + numbers.Error(), "(3.00 ± 0.12)e-06");
  EXPECT_EQ(numbers.Number(3e-6), "3.00e-06");
}

TEST(QuantityNumbers, HasSixDigitsWithoutAnError) {
  for (const auto& error : {std::optional<double>(), std::optional(std::numeric_limits<double>::infinity()),
                            std::optional(std::numeric_limits<double>::quiet_NaN())}) {
    const QuantityNumbers numbers(0.123456789, error);
    EXPECT_EQ(numbers.Value(), "0.123457");
    EXPECT_EQ(numbers.Error(), "");
    EXPECT_EQ(numbers.Number(0.123456789), "0.1235");
  }
}

// 0.25 deg = 0.00436332 rad.
TEST(ReadingText, AddsDegreesToRadians) {
  EXPECT_EQ(ReadingText(0.00436332, "rad"), "0.00436 rad (0.25 deg)");
  EXPECT_EQ(ReadingText(0.00436332, "rad/s"), "0.00436 rad/s (0.25 deg/s)");
  EXPECT_EQ(ReadingText(0.5, "counts"), "0.5 counts");
}

TEST(Prose, IsIndentedBelowItsHeading) { EXPECT_EQ(Heading("Data") + Prose("one two"), "[[Data]]\n    one two\n"); }

// ESC [ starts control sequences, such as clearing the screen; U+009B is the same in one character.
TEST(Printable, ContainsNoTerminalControlCharacters) {
  EXPECT_EQ(Printable("a\x1B[2Jb\n\x7F\xC2\x9Bm.csv"), "a?[2Jb???m.csv");
  EXPECT_EQ(Printable("Mañana τ ±.csv"), "Mañana τ ±.csv");
}

}  // namespace
}  // namespace pendulum::text_parts_test
