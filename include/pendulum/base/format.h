// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pendulum {

/// A number for a sentence: that many significant digits, in the shorter of fixed and scientific notation.
std::string FormatNumber(double value, int significant_digits);

}  // namespace pendulum
