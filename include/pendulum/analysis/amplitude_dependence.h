// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/analysis/homogeneity.h"

namespace pendulum {

/// The amplitude of a fitted motion, rad: its root mean square from the release on; NaN where there is none.
double MeanAmplitude(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Whether a slope with amplitude² explains what differs: estimates of whole recordings, at the amplitude that weighs
/// there, and slopes within recordings (Constancy) are told together by one line (MODEL.md eq. (59)). amplitudes: K,
/// rad, used where a recording has no windows. Nothing where fewer than three numbers tell of it, or all amplitudes are
/// one.
std::optional<AmplitudeDependence> TestAmplitudeDependence(const std::vector<RunAlone>& runs,
                                                           const SharedParameter& parameter,
                                                           const std::vector<double>& amplitudes);

}  // namespace pendulum
