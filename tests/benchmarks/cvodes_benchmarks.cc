// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>

#include "ceres_baseline.h"
#include "cvodes_cost.h"
#include "pendulum_benchmarks.h"

namespace pendulum::benchmarks {
namespace {

std::unique_ptr<ceres::CostFunction> CvodesCostOf(const Recording& recording, double relative_tolerance) {
  return MakeCvodesCost(recording, ReferenceRig().gravity_torque.value, relative_tolerance);
}

void EvaluateCvodes(benchmark::State& state, double relative_tolerance) {
  const Recording recording = ReferenceRecording();
  TimeEvaluation(state, *CvodesCostOf(recording, relative_tolerance), true);
}

void SolveCvodes(benchmark::State& state, double relative_tolerance) {
  const Recording recording = ReferenceRecording();
  TimeSolve(state, *CvodesCostOf(recording, relative_tolerance), kGuess);
}

}  // namespace

void RegisterCvodesBenchmarks() {
  for (const auto& [name, tolerance] : {std::pair{"1e-6", 1e-6}, std::pair{"1e-8", 1e-8}}) {
    benchmark::RegisterBenchmark(("cvodes/rtol:" + std::string(name) + "/sensitivities").c_str(), EvaluateCvodes,
                                 tolerance)
        ->Unit(benchmark::kMicrosecond);
  }
  benchmark::RegisterBenchmark("cvodes/rtol:1e-6/solve", SolveCvodes, 1e-6)->Unit(benchmark::kMicrosecond);
}

}  // namespace pendulum::benchmarks
