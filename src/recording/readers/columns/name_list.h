// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

/// Lists of names for sentences.
namespace pendulum {

/// "A, B and C"; only the first ones if there are many.
inline std::string ListOf(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    list += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return list + (names.size() > kShown ? ", ..." : "");
}

/// The error and advice if two or more columns could be the quantity.
inline std::string SeveralQuantities(const std::vector<std::string>& names) {
  return ListOf(names) + " could " + (names.size() == 2 ? "both" : "all") +
         " be the quantity; choose one with --value_column";
}

}  // namespace pendulum
