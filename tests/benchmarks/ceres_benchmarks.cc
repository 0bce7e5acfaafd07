// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "ceres_users.h"
#include "pendulum_benchmarks.h"

namespace pendulum::benchmarks {
namespace {

/// A start as a user would guess it from the rig's geometry and the plot.
constexpr Parameters kGuess = {0.0762, 0.0036, 0.001, 0.41, 1.93, 0.002};

Parameters OurStartValues() {
  const FitProblem problem = MakeEvaluationPoint("coulomb", StartKind::kRelease).problem;
  Parameters start{};
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = problem.first_guess[i] * problem.si_per_internal[i];
  return start;
}

/// Largest error of the trajectory at these parameters [rad].
double MaxTrajectoryError(const ceres::CostFunction& cost, const Parameters& parameters) {
  EvaluationPoint point = MakeEvaluationPoint("coulomb", StartKind::kRelease);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    point.parameters[i] = parameters[i] / point.problem.si_per_internal[i];
  }
  Eigen::VectorXd residuals(kSamples);
  const double* block = parameters.data();
  cost.Evaluate(&block, residuals.data(), nullptr);
  return MaxReadingError(point, ReferenceRecording().value - residuals);
}

/// Residuals, and derivatives if asked for, at the truth.
template <template <typename> typename Swing>
void Evaluate(benchmark::State& state, bool with_jacobian) {
  const Recording recording = ReferenceRecording();
  const RungeKuttaCost<Swing> cost = MakeRungeKuttaCost<Swing>(recording);
  const double* block = kTruth.data();
  std::vector<double> residuals(kSamples);
  std::vector<double> jacobian(kSamples * kTruth.size());
  double* jacobian_block = jacobian.data();
  for (auto _ : state) {
    cost.Evaluate(&block, residuals.data(), with_jacobian ? &jacobian_block : nullptr);
    benchmark::DoNotOptimize(residuals.data());
    benchmark::DoNotOptimize(jacobian.data());
    benchmark::ClobberMemory();
  }
  state.counters["max_error_rad"] = MaxTrajectoryError(cost, kTruth);
  state.counters["samples"] = kSamples;
}

template <template <typename> typename Swing>
void Solve(benchmark::State& state, const Parameters& start) {
  const Recording recording = ReferenceRecording();
  RungeKuttaCost<Swing> cost = MakeRungeKuttaCost<Swing>(recording);
  CeresSolution solution;
  for (auto _ : state) {
    solution = SolveByCeres(cost, start);
    if (!solution.summary.IsSolutionUsable()) return state.SkipWithError(solution.summary.message.c_str());
  }
  state.counters["std_errors_from_optimum"] = DistanceFromOptimum(solution.parameters);
  state.counters["max_error_rad"] = MaxTrajectoryError(cost, solution.parameters);
  state.counters["iterations"] = static_cast<double>(solution.summary.iterations.size()) - 1;
  state.counters["samples"] = kSamples;
}

template <template <typename> typename Swing>
void Register(const std::string& name) {
  const auto add = [&](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((name + what).c_str(), run)->Unit(benchmark::kMicrosecond);
  };
  add("/trajectory", [](benchmark::State& state) { Evaluate<Swing>(state, false); });
  add("/sensitivities", [](benchmark::State& state) { Evaluate<Swing>(state, true); });
  add("/solve", [](benchmark::State& state) { Solve<Swing>(state, kGuess); });
  add("/solve_from_our_start", [](benchmark::State& state) { Solve<Swing>(state, OurStartValues()); });
}

}  // namespace

void RegisterCeresBenchmarks() {
  Register<SmoothedSwing>("smoothed_rk4");
  Register<LocatedSwing>("located_rk4");
}

}  // namespace pendulum::benchmarks
