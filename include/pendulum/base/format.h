// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pendulum {

/// `value` with at most `significant_digits` digits, as printf's %g writes it.
std::string NumberText(double value, int significant_digits);

/// The shortest decimal text that reads back as exactly `value`, for files and messages.
std::string NumberText(double value);

/// A probability as messages show it: "0.03", "< 1e-99".
std::string ProbabilityText(double p);

/// Degrees of freedom as messages show them: "1 degree of freedom", "8 degrees of freedom".
std::string DegreesOfFreedomText(int degrees);

/// One lower-case hexadecimal digit; `digit` is below 16.
constexpr char HexDigit(unsigned int digit) { return "0123456789abcdef"[digit]; }

/// Text from a file in double quotes, for a message: about 40 bytes as shown. Unprintable bytes and bytes that could
/// control a terminal become \xNN.
std::string Quoted(std::string_view text);

/// A text with a capital first letter, if that is one of a to z.
std::string Capitalized(std::string text);

/// "512 MiB", or bytes if they are not whole MiB.
std::string SizeText(std::size_t bytes);

/// A word of a command for a POSIX shell: in single quotes if it has special characters.
std::string ShellWord(const std::string& word);

/// Names joined by commas, for a sentence: "inertia, viscous, zero_angle". An item is a name or has a member `name`.
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

/// "A, B and C"; only the first ones if there are more than `most`.
std::string ListWithAnd(const std::vector<std::string>& names, std::size_t most = 8);

}  // namespace pendulum
