// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// How the numbers of one quantity are shown: x / 10^exponent with so many decimals.
struct Rounding {
  int decimals = 0;  ///< 0 or more.
  int exponent = 0;  ///< 0 unless powers of ten save many zeros.
};

/// A value and its standard error, to be printed with " ± " between them.
struct ValueAndError {
  std::string value;  ///< "0.83", or "(3.00" when a power of ten follows the error.
  std::string error;  ///< "0.12", or "0.12)e-06".
};

/// The rounding of the Particle Data Group (M. Tanabashi et al., Review of Particle Physics, Phys. Rev. D 98, 030001,
/// 2018, Introduction, section 5.3): an error with leading digits 100 to 354 has two significant digits, 355 to 949
/// one, 950 to 999 is rounded up to 1000 and has two; the value has the same decimal. Any unit; error > 0, both finite.
Rounding PdgRounding(double value, double error);

inline constexpr int kDigitsWithoutError = 4;

/// The rounding that shows x != 0 to so many significant digits, trailing zeros included.
Rounding SignificantRounding(double x, int digits);

/// Significant digits that x != 0 has under a rounding, at least 1.
int SignificantDigits(double x, const Rounding& rounding);

/// Value ± error by PdgRounding. An error that is not positive, or too small for a double to show the value to its
/// decimal, leaves the value at 12 significant digits.
ValueAndError PdgText(double value, double error);

/// x as the rounding says: "0.830", "3.00e-06"; never "-0.000".
std::string RoundedText(double x, const Rounding& rounding);

/// x with so many decimals, as printf's %f.
std::string FixedText(double x, int decimals);

}  // namespace pendulum
