// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

namespace pendulum {

/// Whether N residuals that are more than white noise are a misfit of the swing, and not slow noise: noise neither
/// prefers harmonics of the swing nor changes its size from period to period (MODEL.md eq. (5.6), (5.7)). A recording
/// of too few periods or samples to tell counts as a misfit. Each of the two tests has a level of 1e-3.
///
/// time: s, increasing; fitted: the trajectory in the unit of the readings, which oscillates once in a period; z:
/// quantile residuals; squared_inflation: 1 + 2 Σ ρ_k² of their autocorrelation (Autocorrelation::SquaredInflation); if
/// it is not known, changes of size are not tested.
bool IsSwingMisfit(const Eigen::VectorXd& time, const Eigen::VectorXd& fitted, const Eigen::VectorXd& z,
                   std::optional<double> squared_inflation);

}  // namespace pendulum
