// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Values of parameters by name, in the units of a fit's report.
using ParameterValues = std::map<std::string, double, std::less<>>;

/// The noise-free readings of a fit for other values of its parameters. A parameter that is not named keeps its
/// estimate. What the fit subtracted from the readings (FitReport::correction) is part of the result, as it is of
/// FitReport::fitted, to which the result is equal at the estimates but for the error of the trajectory.
///
/// used: the N fitted samples.     fit, rig: the fit of this recording and the rig of its report's units.
/// Returns N x 1, in the unit of used.value.
/// kInvalidArgument: the fit has no such parameter; a value is not finite or outside of the parameter's range; the
/// inertia is below a hundredth of the estimate, so that a motion could take minutes to compute; the release is outside
/// of the recording; friction holds the pendulum at its start. kFailedPrecondition: the fit has no estimates.
/// No fit is made: 1 ms for 20 000 samples.
Result<Eigen::VectorXd> ReadingsAt(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig,
                                   const ParameterValues& values);

}  // namespace pendulum
