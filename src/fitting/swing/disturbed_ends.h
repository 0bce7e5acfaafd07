// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Limits of the fits that compare windows: samples, samples per half swing, and trajectories.
inline constexpr Eigen::Index kMaxTrialSamples = 3000;
inline constexpr double kPerHalfSwing = 12;
inline constexpr int kMaxTrialTraces = 60;

/// Numbers of turning points that may be left out at one end of a window: 0, 1, 2, 4 and so on, and a quarter of all.
std::vector<std::size_t> TrimCandidates(std::size_t turns);

/// Turning points at which a window may begin or end. The hold and the first sample are excluded.
std::vector<double> InnerTurningPoints(const FreeSwing& swing);

/// Whether the user gave a value, bound or prior for the start of the motion. It refers to the first sample or to the
/// release in the present window, so the window must keep its beginning.
bool ConstrainsStart(const FitOptions& options);

/// Leaves out disturbed parts at both ends of the swing, unless the user chose the end.
void LeaveOutDisturbedEnds(const Recording& recording, const FitOptions& options, FreeSwing& swing);

}  // namespace pendulum
