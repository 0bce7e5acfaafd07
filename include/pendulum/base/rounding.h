// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

namespace pendulum {

/// The number format of one quantity: x / 10^exponent with `decimals` decimals.
struct Rounding {
  int decimals = 0;  ///< 0 or more.
  int exponent = 0;  ///< 0 unless a power of ten avoids many zeros.
};

/// A value and its standard error, printed with " ± " between them.
struct ValueAndError {
  std::string value;  ///< "0.83", or "(3.00" if a power of ten follows the error.
  std::string error;  ///< "0.12", or "0.12)e-06".
};

/// The rounding of the Particle Data Group (M. Tanabashi et al., Review of Particle Physics, Phys. Rev. D 98, 030001,
/// 2018, Introduction, section 5.3). An error with leading digits 100 to 354 gets two significant digits, 355 to 949
/// one; 950 to 999 is rounded up to 1000 and gets two. The value has the same last decimal. Any unit; error > 0, both
/// finite.
Rounding PdgRounding(double value, double error);

inline constexpr int kDigitsWithoutError = 4;

/// The rounding that shows x != 0 with `digits` significant digits, including trailing zeros.
Rounding SignificantRounding(double x, int digits);

/// Significant digits of x != 0 under a rounding, at least 1.
int SignificantDigits(double x, const Rounding& rounding);

/// Value ± error by PdgRounding. If the error is not positive, or too small for the digits of a double, the value has
/// 12 significant digits.
ValueAndError PdgText(double value, double error);

/// "0.83 ± 0.12", "(3.00 ± 0.12)e-06": value ± error by PdgRounding. Six significant digits of the value alone if the
/// error is not positive.
std::string PlusMinusText(double value, double error);

/// x in the format `rounding`: "0.830", "3.00e-06"; never "-0.000".
std::string RoundedText(double x, const Rounding& rounding);

/// x with `decimals` decimals, as with printf's %f.
std::string FixedText(double x, int decimals);

/// "50490.1" and "50510.1": the ends of a span, from < to, with as many decimals as its length needs for four digits,
/// however large the ends are.
std::pair<std::string, std::string> SpanTexts(double from, double to);

}  // namespace pendulum
