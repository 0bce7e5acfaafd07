// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <string>

#include <benchmark/benchmark.h>
#include <malloc.h>

#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

/// A field of /proc/self/status, such as VmRSS [bytes]; 0 if it does not exist.
double StatusBytes(const std::string& field) {
  std::ifstream status("/proc/self/status");
  std::string name;
  double kilobytes = 0;
  while (status >> name) {
    if (name == field + ":" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

/// Resets the peak of resident memory (VmHWM) to the present value. Returns false if the kernel does not allow it.
bool ResetPeak() {
  malloc_trim(0);
  return static_cast<bool>(std::ofstream("/proc/self/clear_refs") << "5" << std::flush);
}

/// Measures resident memory, not allocations: it includes the memory of Eigen and Ceres, and only pages in use.
void FitMemory(benchmark::State& state, int samples) {
  const Recording recording = ReferenceRecording(samples);
  FitOptions options;
  options.rig = ReferenceRig();
  double bytes = 0;
  for (auto _ : state) {
    if (!ResetPeak()) return state.SkipWithError("/proc/self/clear_refs cannot be written");
    const double before = StatusBytes("VmRSS");
    const Result<FitReport> fit = FitRecording(recording, options);
    if (!fit) return state.SkipWithError(fit.error().message().c_str());
    bytes = StatusBytes("VmHWM") - before;
  }
  state.counters["bytes_per_sample"] = bytes / samples;
  state.counters["samples"] = samples;
}

}  // namespace

void RegisterMemoryBenchmarks() {
  constexpr int kMillion = 1'000'000;
  benchmark::RegisterBenchmark("fit_memory/samples:1000000", FitMemory, kMillion)
      ->Iterations(1)
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace pendulum::benchmarks
