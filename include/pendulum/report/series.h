// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pendulum/fitting/fit.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The samples beside the fit as CSV, one line a sample in SI with every digit a double has:
/// time_s,measured_rad,fitted_rad,residual_rad (or ..._rad_s for a rate), residual = measured - fitted.
/// used: the N samples that were fitted. Where the fit has not N numbers, or one that is not finite, its fields are
/// empty.
std::string ToResidualCsv(const Recording& used, const FitReport& fit);

}  // namespace pendulum
