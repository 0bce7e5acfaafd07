// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/model/parameter.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The noise-free readings of a fit for other values of its parameters. A parameter that is not named keeps its
/// estimate. What the fit subtracted from the readings (FitReport::correction) is part of the result, as it is of
/// FitReport::fitted, to which the result is equal at the estimates but for the error of the trajectory.
///
/// used: the N fitted samples.     fit, rig: the fit of this recording and the rig of its report's units.
/// values: in the units of the report.
/// Returns N x 1, in the unit of used.value.
/// kInvalidArgument: the fit has no such parameter; a value is not finite or outside of the parameter's range; the
/// inertia is below a hundredth of the estimate; the release is outside of the recording; friction holds the pendulum
/// at its start; the motion needs more steps than one of a fit may have. kFailedPrecondition: the fit has no estimates.
/// kTryAgain: a stop was requested before the end.
///
/// No fit is made: 1 ms for 20 000 samples near the estimates. A fast motion takes up to 0.3 s for 90 000 samples over
/// 16 000 periods.
Result<Eigen::VectorXd> ReadingsAt(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig,
                                   const ParameterValues& values, const std::stop_token& stop = {});

}  // namespace pendulum
