// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/rounding.h"

#include <limits>

#include <gtest/gtest.h>

namespace pendulum::rounding_test {
namespace {

std::string Pdg(double value, double error) {
  const ValueAndError text = PdgText(value, error);
  return text.value + " ± " + text.error;
}

// The two examples of the Review of Particle Physics, Introduction, section 5.3.
TEST(PdgText, ReproducesThePublishedExamples) {
  EXPECT_EQ(Pdg(0.827, 0.119), "0.83 ± 0.12");
  EXPECT_EQ(Pdg(0.827, 0.367), "0.8 ± 0.4");
}

TEST(PdgText, ChangesTheNumberOfDigitsAtTheLimitsOfTheRule) {
  EXPECT_EQ(Pdg(0.827, 0.100), "0.83 ± 0.10");
  EXPECT_EQ(Pdg(0.827, 0.354), "0.83 ± 0.35");
  EXPECT_EQ(Pdg(0.827, 0.3549), "0.83 ± 0.35");  // three digits are compared without rounding
  EXPECT_EQ(Pdg(0.827, 0.355), "0.8 ± 0.4");
  EXPECT_EQ(Pdg(0.827, 0.949), "0.8 ± 0.9");
  EXPECT_EQ(Pdg(0.827, 0.950), "0.8 ± 1.0");
  EXPECT_EQ(Pdg(0.827, 0.999), "0.8 ± 1.0");
  EXPECT_EQ(Pdg(82.7, 9.5), "83 ± 10");
}

TEST(PdgText, RoundsDecimalHalvesOfTheErrorUpwards) {
  EXPECT_EQ(Pdg(4.778, 0.0075), "4.778 ± 0.008");
  EXPECT_EQ(Pdg(4.778, 0.00145), "4.7780 ± 0.0015");
}

TEST(PdgText, UsesAPowerOfTenForSmallNumbersAndLargeErrors) {
  EXPECT_EQ(Pdg(3e-6, 1.2e-7), "(3.00 ± 0.12)e-06");
  EXPECT_EQ(Pdg(0.0001234, 5e-6), "0.000123 ± 0.000005");
  EXPECT_EQ(Pdg(1234567, 67800), "(1.23 ± 0.07)e+06");
  EXPECT_EQ(Pdg(12345, 25), "12345 ± 25");
  EXPECT_EQ(Pdg(123456789, 0.3), "123456789.00 ± 0.30");
}

TEST(PdgText, WritesZerosBeforeThePointOfNumbersBelowAMillion) {
  EXPECT_EQ(Pdg(84, 41), "80 ± 40");
  EXPECT_EQ(Pdg(-3, 41), "0 ± 40");
  EXPECT_EQ(Pdg(123, 36), "120 ± 40");
  EXPECT_EQ(Pdg(987, 360), "1000 ± 400");
  EXPECT_EQ(Pdg(15123, 1621), "15100 ± 1600");
  EXPECT_EQ(Pdg(999700, 3600), "(1.000 ± 0.004)e+06");  // a million after rounding
  EXPECT_EQ(RoundedText(123, PdgRounding(123, 36)), "120");
}

TEST(PdgText, WritesOneDigitBeforeThePointAlsoAfterRoundingUp) {
  EXPECT_EQ(Pdg(9.97e-6, 5e-7), "(1.00 ± 0.05)e-05");
  EXPECT_EQ(Pdg(3e-6, 9.6e-6), "(0.3 ± 1.0)e-05");
  EXPECT_EQ(Pdg(6e-8, 5e-7), "(1 ± 5)e-07");
  EXPECT_EQ(Pdg(4e-8, 5e-7), "(0 ± 5)e-07");
  EXPECT_EQ(Pdg(-9.997e7, 5e5), "(-1.000 ± 0.005)e+08");
}

TEST(PdgText, RoundsTheValueToTheDecimalOfALargeError) {
  EXPECT_EQ(Pdg(0.02, 12), "0 ± 12");
  EXPECT_EQ(Pdg(0, 0.0012), "0.0000 ± 0.0012");
  EXPECT_EQ(Pdg(-0.0001, 0.02), "0.000 ± 0.020");
  EXPECT_EQ(Pdg(-0.0151, 0.02), "-0.015 ± 0.020");
}

TEST(PdgText, ShowsSignificantDigitsOnly) {
  EXPECT_EQ(Pdg(0.079, 0), "0.079 ± 0");
  EXPECT_EQ(Pdg(0.07900000000001234, 1e-16), "0.079 ± 1e-16");
}

TEST(PlusMinusText, ShowsTheValueAloneWithoutAnError) {
  EXPECT_EQ(PlusMinusText(0.0790123, 0.0028), "0.0790 ± 0.0028");
  EXPECT_EQ(PlusMinusText(3.0041e-6, 1.2e-7), "(3.00 ± 0.12)e-06");
  EXPECT_EQ(PlusMinusText(0.07901234, 0), "0.0790123");
  EXPECT_EQ(PlusMinusText(0.07901234, std::numeric_limits<double>::quiet_NaN()), "0.0790123");
}

TEST(RoundedText, RoundsAllNumbersOfAQuantityAlike) {
  const Rounding milli = PdgRounding(0.0790, 0.0012);
  EXPECT_EQ(RoundedText(0.08123, milli), "0.0812");
  const Rounding micro = PdgRounding(3e-6, 1.2e-7);
  EXPECT_EQ(RoundedText(2.76e-6, micro), "2.76e-06");
  EXPECT_EQ(RoundedText(-2e-9, micro), "0");  // not 0.00e-06
}

TEST(SignificantRounding, KeepsTrailingZeros) {
  EXPECT_EQ(RoundedText(1.8, SignificantRounding(1.8, 3)), "1.80");
  EXPECT_EQ(RoundedText(0.00017, SignificantRounding(0.00017, 3)), "0.000170");
  EXPECT_EQ(RoundedText(1.7e-5, SignificantRounding(1.7e-5, 3)), "1.70e-05");
}

TEST(SignificantDigits, CountsFromTheFirstNonzeroDigit) {
  EXPECT_EQ(SignificantDigits(0.0790, {4, 0}), 3);
  EXPECT_EQ(SignificantDigits(3.1e-6, {2, -6}), 3);
  EXPECT_EQ(SignificantDigits(0.0001, {2, 0}), 1);
}

TEST(FixedText, MatchesPrintf) { EXPECT_EQ(FixedText(-1.005e300, 0).substr(0, 5), "-1005"); }

TEST(SpanTexts, HaveTheDecimalsThatTheLengthNeeds) {
  const auto texts = [](double from, double to) {
    const auto [first, last] = SpanTexts(from, to);
    return first + " " + last;
  };
  EXPECT_EQ(texts(0, 19.99), "0 19.99");
  EXPECT_EQ(texts(50490.123, 50510.123), "50490.12 50510.12");  // 20.00 s
  EXPECT_EQ(texts(1712345678.5, 1712345690.25), "1712345678.5 1712345690.25");
  EXPECT_EQ(texts(-1.5, 36000), "-2 36000");
  EXPECT_EQ(texts(0.001, 0.00525), "0.001 0.00525");
}

}  // namespace
}  // namespace pendulum::rounding_test
