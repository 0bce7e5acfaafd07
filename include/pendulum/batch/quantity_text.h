// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/batch/run_statistics.h"

namespace pendulum {

// The numbers of a summary, as the text of refit_pendulums and the page show them.

/// A value of a distribution with the decimals of its standard deviation, and so that the median has three digits or
/// more: one outlier makes the standard deviation large and leaves the median as it is.
std::string ValueText(const Distribution& distribution, double value);

/// A standard error or a spread with two digits; "-" if there is none.
std::string SpreadText(const std::optional<double>& size);

/// A ratio of scatter to errors with three digits.
std::string RatioText(double ratio);

}  // namespace pendulum
