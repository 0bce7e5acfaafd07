// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum::benchmarks {

/// trajectory/..., sensitivities/...: one trajectory for every model with both starts, for 10^3 to 10^6 samples, and at
/// several accuracies.
void RegisterTrajectoryBenchmarks();

/// start_values, fit, parse_csv, file_to_json, json, and fit/samples:N.
void RegisterFitBenchmarks();

/// covariance, profile, bootstrap: the cost of each kind of errors.
void RegisterErrorBenchmarks();

/// fit_jointly/SCENARIO/recordings:K: K separate fits plus the joint fit, relative to the time of one fit.
void RegisterJointBenchmarks();

/// batch/refit: a batch of files on all cores, and the share of the cores' capacity that it uses.
void RegisterBatchBenchmarks();

/// smoothed_rk4/..., located_rk4/..., both also _flattened, located_odeint/...: code written by hand with Ceres, for
/// comparison; see users_costs.h.
void RegisterCeresBenchmarks();

/// tiny_solver/...: our trajectory's N residuals solved by ceres::TinySolver.
void RegisterTinySolverBenchmarks();

/// cvodes/rtol:R/...: residuals and derivatives by SUNDIALS' forward sensitivities, solved by Ceres.
void RegisterCvodesBenchmarks();

/// floor/trajectory/..., floor/sensitivities/...: the minimum arithmetic for the samples, for any implementation.
void RegisterFloorBenchmarks();

/// fit_memory/samples:N: resident memory in bytes in addition to the data.
void RegisterMemoryBenchmarks();

}  // namespace pendulum::benchmarks
