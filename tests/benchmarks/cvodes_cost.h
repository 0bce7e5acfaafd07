// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <ceres/cost_function.h>

#include "pendulum/recording/recording.h"

namespace pendulum::benchmarks {

/// What users of a library of sensitivities write: residuals of a recording, measured - modelled [rad], and their
/// derivatives by the six parameters, by SUNDIALS' CVODES. Adams' method; forward sensitivities of angle and rate with
/// respect to inertia, viscous, coulomb and release_angle beside the state (simultaneous corrector), their right-hand
/// side by hand; friction's sign smoothed to tanh(ω / 0.01 rad/s). The recording must outlive it.
std::unique_ptr<ceres::CostFunction> MakeCvodesCost(const Recording& recording, double gravity_torque,
                                                    double relative_tolerance);

}  // namespace pendulum::benchmarks
