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

/// How far a run is from its group (Outlier::z) with three digits; "-" if that is not known.
std::string DistanceText(double z);

/// A ratio of scatter to errors with three digits.
std::string RatioText(double ratio);

}  // namespace pendulum
