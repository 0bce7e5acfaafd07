// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/rounding.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

constexpr int kMaxDigits = 12;        // significant digits of a value; a reader has no use for more
constexpr int kMinExponent = -4;      // numbers below 1e-4 are shown with a power of ten, as with %g
constexpr int kPlainExponent = 5;     // "15100 ± 1600" is read more easily than "(1.51 ± 0.16)e+04"
constexpr std::size_t kBuffer = 352;  // the largest double has 309 digits before the point

/// The three leading decimal digits (100 to 999) of x != 0, and the power of ten of the first one.
struct LeadingDigits {
  int digits = 0;
  int exponent = 0;
};

LeadingDigits LeadingDigitsOf(double x) {
  std::array<char, kBuffer> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::abs(x), std::chars_format::scientific);
  const std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  const std::size_t e = text.find('e');
  LeadingDigits leading;
  if (e == std::string_view::npos) return leading;  // not a finite number
  int count = 0;
  for (const char c : text.substr(0, e)) {
    if (c == '.' || count == 3) continue;
    leading.digits = 10 * leading.digits + (c - '0');
    ++count;
  }
  for (; count < 3; ++count) leading.digits *= 10;
  leading.exponent = std::atoi(text.data() + e + 1);
  return leading;
}

/// The powers of ten of an error's first digit and last decimal, and the rounded error. Decimal digits are rounded half
/// up, so 0.0075 becomes 0.008 although the nearest double is below it.
struct RoundedError {
  int first = 0, last = 0;
  double error = 0;
};

RoundedError RoundError(double error) {
  const auto [digits, exponent] = LeadingDigitsOf(error);
  const int tens = (digits + 5) / 10;
  const int hundreds = (digits + 50) / 100;
  if (digits <= 354) return {exponent, exponent - 1, tens * std::pow(10.0, exponent - 1)};
  if (digits <= 949) return {exponent, exponent, hundreds * std::pow(10.0, exponent)};
  return {exponent + 1, exponent, std::pow(10.0, exponent + 1)};
}

/// The format of numbers with the first digit at 10^first and the last at 10^last.
Rounding RoundingTo(int first, int last) {
  last = std::max(last, first - kMaxDigits + 1);
  if (first < kMinExponent || last > 0) return {std::max(0, first - last), first};
  return {-last, 0};
}

/// The power of ten of the first digit of value ± error, both rounded to the last decimal of the error.
int FirstDigit(double value, const RoundedError& error) {
  if (value == 0) return error.first;
  const int first = LeadingDigitsOf(value).exponent;
  const bool is_carried =
      std::round(std::abs(value) / std::pow(10.0, error.last)) >= std::pow(10.0, first - error.last + 1);
  return std::max(error.first, is_carried ? first + 1 : first);
}

std::string ExponentText(int exponent) {
  if (exponent == 0) return "";
  const std::string digits = std::to_string(std::abs(exponent));
  return std::string(exponent < 0 ? "e-" : "e+") + (digits.size() < 2 ? "0" : "") + digits;
}

/// Whether zeros stand before the point instead of a power of ten.
bool IsPlain(const Rounding& rounding) { return rounding.exponent > 0 && rounding.exponent <= kPlainExponent; }

std::string Mantissa(double x, const Rounding& rounding) {
  std::string text = FixedText(rounding.exponent == 0 ? x : x / std::pow(10.0, rounding.exponent), rounding.decimals);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return zero && text[0] == '-' ? text.substr(1) : text;
}

}  // namespace

Rounding PdgRounding(double value, double error) {
  const RoundedError rounded = RoundError(error);
  return RoundingTo(FirstDigit(value, rounded), rounded.last);
}

Rounding SignificantRounding(double x, int digits) {
  const int first = LeadingDigitsOf(x).exponent;
  return RoundingTo(first, first - digits + 1);
}

int SignificantDigits(double x, const Rounding& rounding) {
  return std::max(1, LeadingDigitsOf(x).exponent - (rounding.exponent - rounding.decimals) + 1);
}

ValueAndError PdgText(double value, double error) {
  if (!(error > 0)) return {NumberText(value, kMaxDigits), NumberText(error, 2)};
  const RoundedError rounded = RoundError(error);
  const int first = FirstDigit(value, rounded);
  if (first - rounded.last >= kMaxDigits) return {NumberText(value, kMaxDigits), NumberText(error, 2)};
  const Rounding rounding = RoundingTo(first, rounded.last);
  if (IsPlain(rounding)) return {RoundedText(value, rounding), RoundedText(rounded.error, rounding)};
  const std::string exponent = ExponentText(rounding.exponent);
  if (exponent.empty()) return {Mantissa(value, rounding), Mantissa(rounded.error, rounding)};
  return {"(" + Mantissa(value, rounding), Mantissa(rounded.error, rounding) + ")" + exponent};
}

std::string PlusMinusText(double value, double error) {
  constexpr int kDigits = 6;
  if (!(error > 0)) return NumberText(value, kDigits);
  const ValueAndError text = PdgText(value, error);
  return text.value + " ± " + text.error;
}

std::string RoundedText(double x, const Rounding& rounding) {
  if (IsPlain(rounding)) {
    const double unit = std::pow(10.0, rounding.exponent - rounding.decimals);
    return FixedText(unit * std::round(x / unit) + 0.0, 0);  // + 0.0: never -0
  }
  const std::string mantissa = Mantissa(x, rounding);
  const bool is_zero = mantissa.find_first_of("123456789") == std::string::npos;
  return is_zero && rounding.exponent != 0 ? "0" : mantissa + ExponentText(rounding.exponent);
}

std::string FixedText(double x, int decimals) {
  std::array<char, kBuffer> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::fixed, std::min(decimals, 40));
  return {buffer.data(), end};
}

std::pair<std::string, std::string> SpanTexts(double from, double to) {
  const Rounding rounding = SignificantRounding(to - from, kDigitsWithoutError);
  const int decimals = std::max(0, rounding.decimals - rounding.exponent);
  const auto text = [&](double end) {
    std::string number = FixedText(end, decimals);
    if (decimals > 0) number.erase(number.find_last_not_of('0') + 1);
    if (number.ends_with('.')) number.pop_back();
    return number;
  };
  return {text(from), text(to)};
}

}  // namespace pendulum
