// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pendulum::benchmarks {

/// trajectory/..., sensitivities/...: one trajectory, of every model with both starts, and of 10^3 to 10^6 samples.
void RegisterTrajectoryBenchmarks();

/// start_values, fit, parse_csv, file_to_json, and fit/samples:N.
void RegisterFitBenchmarks();

/// fit_jointly/SCENARIO/recordings:K: K fits alone and the joint one, and how many times one fit that takes.
void RegisterJointBenchmarks();

/// smoothed_rk4/..., located_rk4/...: the same by hand with Ceres, to compare with.
void RegisterCeresBenchmarks();

/// fit_memory/samples:N: bytes of resident memory beyond the data.
void RegisterMemoryBenchmarks();

}  // namespace pendulum::benchmarks
