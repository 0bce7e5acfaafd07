// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum::benchmarks {

/// trajectory/..., sensitivities/...: one trajectory, of every model with both starts, of 10^3 to 10^6 samples, and at
/// several accuracies.
void RegisterTrajectoryBenchmarks();

/// start_values, fit, parse_csv, file_to_json, json, and fit/samples:N.
void RegisterFitBenchmarks();

/// covariance, profile, bootstrap: what each kind of errors costs.
void RegisterErrorBenchmarks();

/// fit_jointly/SCENARIO/recordings:K: K fits alone and the joint one, and how many times one fit that takes.
void RegisterJointBenchmarks();

/// batch/refit: a batch of files on all cores, and what share of them it has.
void RegisterBatchBenchmarks();

/// smoothed_rk4/..., located_rk4/..., the same _flattened, located_odeint/...: the same by hand with Ceres, to compare
/// with; see users_costs.h.
void RegisterCeresBenchmarks();

/// tiny_solver/...: our trajectory's N residuals solved by ceres::TinySolver.
void RegisterTinySolverBenchmarks();

/// cvodes/rtol:R/...: the same by SUNDIALS' forward sensitivities.
void RegisterCvodesBenchmarks();

/// floor/trajectory/..., floor/sensitivities/...: the least arithmetic that the samples take, whatever is done about
/// it.
void RegisterFloorBenchmarks();

/// fit_memory/samples:N: bytes of resident memory beyond the data.
void RegisterMemoryBenchmarks();

}  // namespace pendulum::benchmarks
