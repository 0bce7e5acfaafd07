// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/rounding.h"

namespace pendulum {

inline constexpr int kTextIndent = 4;  ///< Columns; indents everything below a heading.
inline constexpr int kTextWidth = 80;  ///< Columns of a terminal; the maximal width of a line.
/// How much a text for a terminal says: what a reader needs first, in about 20 lines, or all.
enum class TextExtent { kSummary, kAll };

inline constexpr int kTextDigits = 6;  ///< Significant digits of a number without an error.

/// "[[title]]" as a line.
std::string Heading(const std::string& title);

/// Text wrapped to lines below a heading.
std::string Prose(std::string_view text);

/// A text from outside, such as a file name, with "?" for each character that could control a terminal.
std::string Printable(std::string_view text);

/// A name of JSON in words: "friction law" for "friction_law".
std::string InWords(std::string_view name);

/// A conversion to another unit: numbers times `factor`.
struct Conversion {
  std::string_view unit;
  double factor = 1;
};

/// Degrees for rad, deg/s for rad/s; std::nullopt for other units.
std::optional<Conversion> Degrees(std::string_view unit);

/// A value of residuals or noise with its unit, and also in degrees if it is in radians: "0.00436 rad (0.25 deg)".
std::string ReadingText(double value, const std::string& unit);

/// Formats all numbers of one quantity, times `factor`, to the decimal of its standard error, if it has one.
class QuantityNumbers {
 public:
  QuantityNumbers(double value, const std::optional<double>& std_error, double factor = 1);

  /// The value and "± error", to be printed together: with a power of ten, "(3.00" and "± 0.12)e-06". Error() is empty
  /// if there is no error.
  const std::string& Value() const { return text_.value; }
  std::string Error() const { return text_.error.empty() ? "" : "± " + text_.error; }

  /// Another number of the quantity, or the value without its error.
  std::string Number(double x) const;

  /// A second standard error, "± 0.0010", rounded by its own size; empty if it is missing or not positive.
  std::string SecondError(const std::optional<double>& error) const;

  /// "[lower, upper]" with "?" for a missing end; empty if both are missing.
  std::string Interval(const std::optional<double>& lower, const std::optional<double>& upper) const;

 private:
  double factor_;
  ValueAndError text_;
  std::optional<Rounding> rounding_;
};

}  // namespace pendulum
