// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pendulum/analysis/homogeneity.h"

namespace pendulum {

/// Root mean square of the fitted angle after the release, rad; NaN if the motion cannot be computed, or
/// if it is in counts or volts.
double MeanAmplitude(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Tests whether a linear dependence on amplitude² explains the differences of a parameter. One line is fitted to the
/// estimates of whole recordings and to the slopes within recordings (Constancy; MODEL.md eq. (10.4)). A whole
/// recording is placed at the weighted mean of amplitude² of its windows. amplitudes: K, rad, used for recordings
/// without windows. Returns std::nullopt if there are fewer than three estimates and slopes, or if all amplitudes are
/// equal.
std::optional<AmplitudeDependence> TestAmplitudeDependence(const std::vector<RunAlone>& runs,
                                                           const SharedParameter& parameter,
                                                           const std::vector<double>& amplitudes);

}  // namespace pendulum
