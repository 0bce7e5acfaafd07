// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "pendulum/trajectory/tolerance.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

/// The cost function of a point at the tolerance a fit of it begins with.
std::unique_ptr<TrajectoryCost> CostAt(const EvaluationPoint& point) {
  auto cost = MakeTrajectoryCost(point.problem.model, point.problem.start.start, point.problem.data);
  cost->set_tolerance(TraceTolerance(FitOptions().max_trace_error, point.problem.start.amplitude));
  return cost;
}

void Report(benchmark::State& state, const EvaluationPoint& point, const TrajectoryCost& cost) {
  Eigen::VectorXd readings;
  cost.Readings(point.parameters, &readings, nullptr);
  state.counters["max_error_rad"] = MaxReadingError(point, readings);
  state.counters["samples"] = static_cast<double>(readings.size());
}

/// Sum of squares alone.
void EvaluateCost(benchmark::State& state, const EvaluationPoint& point) {
  const auto cost = CostAt(point);
  double sum = 0;
  for (auto _ : state) {
    if (!cost->SumOfSquares(point.parameters, &sum)) return state.SkipWithError("no trajectory");
    benchmark::DoNotOptimize(sum);
  }
  Report(state, point, *cost);
}

/// Sums of products of residuals and all derivatives: what an iteration of a fit needs.
void EvaluateSums(benchmark::State& state, const EvaluationPoint& point) {
  const auto cost = CostAt(point);
  Eigen::MatrixXd sums;
  std::vector<double> parameters = point.parameters;
  for (auto _ : state) {
    parameters.back() = std::nextafter(parameters.back(), 1.0);  // the cost remembers the sums of the last point
    if (!cost->Sums(parameters, &sums)) return state.SkipWithError("no trajectory");
    benchmark::DoNotOptimize(sums.data());
  }
  Report(state, point, *cost);
}

void Register(const std::string& name, const std::string& model, StartKind start, int samples) {
  const auto add = [&](const std::string& what, auto evaluate) {
    const auto run = [=](benchmark::State& state) { evaluate(state, MakeEvaluationPoint(model, start, samples)); };
    benchmark::RegisterBenchmark((what + "/" + name).c_str(), run)->Unit(benchmark::kMicrosecond);
  };
  add("trajectory", EvaluateCost);
  add("sensitivities", EvaluateSums);
}

}  // namespace

void RegisterTrajectoryBenchmarks() {
  for (const MotionModel& model : MotionModels()) {
    const std::string name(model.name);
    Register(name + "/release", name, StartKind::kRelease, kSamples);
    Register(name + "/moving", name, StartKind::kMoving, kSamples);
  }
  for (const int samples : {1'000, 10'000, 100'000, 1'000'000}) {
    Register("samples:" + std::to_string(samples), "coulomb", StartKind::kRelease, samples);
  }
}

}  // namespace pendulum::benchmarks
