// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "ceres_baseline.h"
#include "pendulum_benchmarks.h"
#include "users_costs.h"

namespace pendulum::benchmarks {
namespace {

using MakeCost = std::unique_ptr<ceres::CostFunction> (*)(const Recording&);

void EvaluateUsersCost(benchmark::State& state, MakeCost make, bool with_jacobian) {
  const Recording recording = ReferenceRecording();
  TimeEvaluation(state, *make(recording), with_jacobian);
}

void SolveUsersCost(benchmark::State& state, MakeCost make, const Parameters& start) {
  const Recording recording = ReferenceRecording();
  TimeSolve(state, *make(recording), start);
}

void Register(const std::string& name, MakeCost make) {
  const auto add = [&](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((name + what).c_str(), run)->Unit(benchmark::kMicrosecond);
  };
  add("/trajectory", [make](benchmark::State& state) { EvaluateUsersCost(state, make, false); });
  add("/sensitivities", [make](benchmark::State& state) { EvaluateUsersCost(state, make, true); });
  add("/solve", [make](benchmark::State& state) { SolveUsersCost(state, make, kGuess); });
  add("/solve_from_our_start", [make](benchmark::State& state) { SolveUsersCost(state, make, OurStartValues()); });
}

}  // namespace

void RegisterCeresBenchmarks() {
  Register("smoothed_rk4", MakeSmoothedRk4Cost);
  Register("smoothed_rk4_flattened", MakeSmoothedRk4FlattenedCost);
  Register("located_rk4", MakeLocatedRk4Cost);
  Register("located_rk4_flattened", MakeLocatedRk4FlattenedCost);
  Register("located_odeint", MakeLocatedOdeintCost);
}

}  // namespace pendulum::benchmarks
