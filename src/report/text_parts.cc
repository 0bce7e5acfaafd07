// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text_parts.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/report/layout.h"

namespace pendulum {

std::string Heading(const std::string& title) { return "[[" + title + "]]\n"; }

std::string Prose(std::string_view text) { return Paragraph(text, std::string(kTextIndent, ' '), kTextWidth); }

std::string Printable(std::string_view text) {
  std::string printable;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool second =
        byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;  // U+0080
    printable += byte < 0x20 || byte == 0x7F || second ? '?' : text[i];
    if (second) ++i;
  }
  return printable;
}

std::optional<Conversion> Degrees(std::string_view unit) {
  if (unit == "rad") return Conversion{"deg", 1 / kRadFromDeg};
  if (unit == "rad/s") return Conversion{"deg/s", 1 / kRadFromDeg};
  return std::nullopt;
}

std::string InWords(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string ReadingText(double value, const std::string& unit) {
  constexpr int kReadingDigits = 3;
  const std::optional<Conversion> degrees = Degrees(unit);
  if (!degrees) return NumberText(value, kReadingDigits) + " " + unit;
  return NumberText(value, kReadingDigits) + " " + unit + " (" + NumberText(value * degrees->factor, kReadingDigits) +
         " " + std::string(degrees->unit) + ")";
}

QuantityNumbers::QuantityNumbers(double value, const std::optional<double>& std_error, double factor)
    : factor_(factor), text_{NumberText(factor * value, kTextDigits), ""} {
  if (!std_error || !std::isfinite(value) || !std::isfinite(*std_error)) return;
  const double error = factor * *std_error;
  text_ = PdgText(factor * value, error);
  if (error > 0) rounding_ = PdgRounding(factor * value, error);
}

std::string QuantityNumbers::Number(double x) const {
  return rounding_ ? RoundedText(factor_ * x, *rounding_) : NumberText(factor_ * x, kDigitsWithoutError);
}

std::string QuantityNumbers::SecondError(const std::optional<double>& error) const {
  if (!error || !(*error > 0)) return "";
  Rounding rounding = PdgRounding(factor_ * *error, factor_ * *error);
  const int last = rounding.exponent - rounding.decimals;
  rounding.exponent = rounding_ ? rounding_->exponent : 0;
  rounding.decimals = std::max(0, rounding.exponent - last);
  return "± " + RoundedText(factor_ * *error, rounding);
}

std::string QuantityNumbers::Interval(const std::optional<double>& lower, const std::optional<double>& upper) const {
  if (!lower && !upper) return "";
  return "[" + (lower ? Number(*lower) : "?") + ", " + (upper ? Number(*upper) : "?") + "]";
}

}  // namespace pendulum
