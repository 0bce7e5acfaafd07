// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The samples beside the fit as CSV, one line a sample in SI with every digit a double has:
/// time_s,measured_rad,fitted_rad,residual_rad (or ..._rad_s for a rate), residual = measured - fitted.
///
/// used: the N samples that were fitted. The last two fields of each line are empty when the fit gives no such N
/// numbers, or one that is not finite.
std::string ToResidualCsv(const Recording& used, const FitReport& fit);

}  // namespace pendulum
