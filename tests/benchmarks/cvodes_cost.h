// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <ceres/cost_function.h>

#include "pendulum/recording/recording.h"

namespace pendulum::benchmarks {

/// Residuals of a recording, measured - modelled [rad], and their derivatives with respect to the six parameters, as
/// users of SUNDIALS' CVODES write them. Uses Adams' method, and forward sensitivities of angle and rate with respect
/// to inertia, viscous, coulomb and release_angle (simultaneous corrector) with a hand-written right-hand side.
/// Friction's sign is smoothed to tanh(ω / 0.01 rad/s). The recording must outlive the cost.
std::unique_ptr<ceres::CostFunction> MakeCvodesCost(const Recording& recording, double gravity_torque,
                                                    double relative_tolerance);

}  // namespace pendulum::benchmarks
