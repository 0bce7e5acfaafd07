// SPDX-License-Identifier: Apache-2.0
// How long a trajectory and a fit take, beside what a user of Ceres would write by hand. README has the
// table from it.
#include "pendulum_benchmarks.h"

#include <benchmark/benchmark.h>

int main(int argc, char** argv) {
  pendulum::benchmarks::RegisterTrajectoryBenchmarks();
  pendulum::benchmarks::RegisterFitBenchmarks();
  pendulum::benchmarks::RegisterJointBenchmarks();
  pendulum::benchmarks::RegisterCeresBenchmarks();
  pendulum::benchmarks::RegisterMemoryBenchmarks();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
