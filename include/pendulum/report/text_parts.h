// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/report/rounding.h"

namespace pendulum {

inline constexpr int kTextIndent = 4;  ///< Columns, of everything below a heading.
inline constexpr int kTextWidth = 80;  ///< Columns, of a terminal: no line is wider.
inline constexpr int kTextDigits = 6;  ///< Significant digits of a number without an error.

/// "[[title]]" as a line.
std::string Heading(const std::string& title);

/// Words filled into lines below a heading.
std::string Prose(std::string_view text);

/// A text from outside, such as the name of a file, with "?" for each character that would steer a terminal.
std::string Printable(std::string_view text);

/// Another unit for a quantity: its numbers times `factor`.
struct Conversion {
  std::string_view unit;
  double factor = 1;
};

/// Degrees for rad, deg/s for rad/s; nothing for other units.
std::optional<Conversion> Degrees(std::string_view unit);

/// A number of residuals or noise with its unit, with degrees beside radians: "0.00436 rad (0.25 deg)".
std::string ReadingText(double value, const std::string& unit);

/// Shows all numbers of one quantity, times `factor`, to the decimal of its standard error, if it has one.
class QuantityNumbers {
 public:
  QuantityNumbers(double value, const std::optional<double>& std_error, double factor = 1);

  /// The value and "± error", which belong side by side: a power of ten brackets both. No error: an empty text.
  const std::string& Value() const { return text_.value; }
  std::string Error() const { return text_.error.empty() ? "" : "± " + text_.error; }

  /// Another number of the quantity, or its value by itself.
  std::string Number(double x) const;

  /// A second standard error, "± 0.0010", to its own decimal; empty when it is absent or not positive.
  std::string SecondError(const std::optional<double>& error) const;

  /// "[lower, upper]" with "?" for an absent end; empty when both are.
  std::string Interval(const std::optional<double>& lower, const std::optional<double>& upper) const;

 private:
  double factor_;
  ValueAndError text_;
  std::optional<Rounding> rounding_;
};

}  // namespace pendulum
