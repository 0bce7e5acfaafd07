// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace pendulum {

/// A number to at most that many significant digits, as printf's %g.
std::string NumberText(double value, int significant_digits);

/// The shortest decimal text that reads back as `value`: what a file or a message shows of a number.
std::string NumberText(double value);

/// A probability for a sentence: "0.03", "< 1e-99".
std::string ProbabilityText(double p);

/// "1 degree of freedom", "8 degrees of freedom".
std::string FreedomText(int degrees);

/// A lower-case hexadecimal digit; `digit` below 16.
constexpr char HexDigit(unsigned int digit) { return "0123456789abcdef"[digit]; }

/// A piece of a file, 40 bytes at most, in double quotes for a message; what does not print or may be obeyed as \xNN.
std::string Quoted(std::string_view text);

/// The names of items for a sentence: "inertia, viscous, zero_angle". Items are names, or have a member `name`.
template <typename Range>
std::string NameList(const Range& items) {
  std::string list;
  for (const auto& item : items) {
    list += list.empty() ? "" : ", ";
    if constexpr (requires { item.name; }) {
      list += item.name;
    } else {
      list += item;
    }
  }
  return list;
}

}  // namespace pendulum
