// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/base/format.h"

namespace pendulum {

/// The error and advice if two or more columns could be the quantity.
inline std::string SeveralQuantities(const std::vector<std::string>& names) {
  return ListWithAnd(names) + " could " + (names.size() == 2 ? "both" : "all") +
         " be the quantity; choose one with --value_column";
}

}  // namespace pendulum
