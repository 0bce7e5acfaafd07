// SPDX-License-Identifier: Apache-2.0
// Times a trajectory and a fit, and compares them with code that a user of Ceres would write, with other libraries, and
// with the minimum arithmetic. README shows the table. --reference_csv=FILE writes the data and times nothing.
#include "pendulum_benchmarks.h"

#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

#include <benchmark/benchmark.h>

#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

void RegisterAll() {
  RegisterTrajectoryBenchmarks();
  RegisterFitBenchmarks();
  RegisterErrorBenchmarks();
  RegisterJointBenchmarks();
  RegisterBatchBenchmarks();
  RegisterCeresBenchmarks();
  RegisterTinySolverBenchmarks();
#ifdef PENDULUM_HAS_SUNDIALS
  RegisterCvodesBenchmarks();
#endif
  RegisterFloorBenchmarks();
  RegisterMemoryBenchmarks();
}

/// Writes the reference run for the timing of other programs; returns the exit code.
int WriteReferenceCsv(const std::string& path) {
  std::ofstream file(path);
  file << ReferenceCsv() << std::flush;
  if (file) return 0;
  std::cerr << "pendulum_benchmarks: cannot write '" << path << "'\n";
  return 1;
}

/// As main. With `--reference_csv=FILE` nothing is timed.
int Run(int argc, char** argv) {
  constexpr std::string_view kReferenceCsv = "--reference_csv=";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with(kReferenceCsv))
      return WriteReferenceCsv(std::string(argument.substr(kReferenceCsv.size())));
  }
  RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace pendulum::benchmarks

int main(int argc, char** argv) { return pendulum::benchmarks::Run(argc, argv); }
