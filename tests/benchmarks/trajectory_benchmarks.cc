// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "pendulum/trajectory/tolerance.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

/// The cost function of a point, at the tolerance with which a fit begins for this permitted error [rad].
std::unique_ptr<TrajectoryCost> CostAt(const EvaluationPoint& point, double max_trace_error) {
  auto cost = MakeTrajectoryCost(point.problem.model, point.problem.start.start, point.problem.data);
  cost->set_tolerance(TraceTolerance(max_trace_error, point.problem.start.amplitude));
  return cost;
}

void Report(benchmark::State& state, const EvaluationPoint& point, const TrajectoryCost& cost, bool with_derivatives) {
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  cost.Readings(point.parameters, &readings, with_derivatives ? &jacobian : nullptr);
  if (with_derivatives) {
    for (Eigen::Index j = 0; j < jacobian.cols(); ++j) jacobian.col(j) /= point.problem.si_per_internal[j];
    state.counters["max_jacobian_error"] = MaxJacobianError(point, jacobian);
  }
  state.counters["max_error_rad"] = MaxReadingError(point, readings);
  state.counters["samples"] = static_cast<double>(readings.size());
}

/// Sum of squares only.
void EvaluateCost(benchmark::State& state, const EvaluationPoint& point) {
  const auto cost = CostAt(point, FitOptions().search.max_trace_error);
  double sum = 0;
  for (auto _ : state) {
    if (!cost->SumOfSquares(point.parameters, &sum)) return state.SkipWithError("no trajectory");
    benchmark::DoNotOptimize(sum);
  }
  Report(state, point, *cost, false);
}

/// Sums of products of residuals and all derivatives, as an iteration of a fit needs them.
void EvaluateSumsTo(benchmark::State& state, const EvaluationPoint& point, double max_trace_error) {
  const auto cost = CostAt(point, max_trace_error);
  Eigen::MatrixXd sums;
  std::vector<double> parameters = point.parameters;
  for (auto _ : state) {
    parameters.back() = std::nextafter(parameters.back(), 1.0);  // the cost caches the sums of the last point
    if (!cost->Sums(parameters, &sums)) return state.SkipWithError("no trajectory");
    benchmark::DoNotOptimize(sums.data());
  }
  Report(state, point, *cost, true);
}

void EvaluateSums(benchmark::State& state, const EvaluationPoint& point) {
  EvaluateSumsTo(state, point, FitOptions().search.max_trace_error);
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
  for (const auto& [name, error] :
       {std::pair{"1e-6", 1e-6}, {"5e-7", 5e-7}, {"1e-8", 1e-8}, {"1e-10", 1e-10}, {"1e-12", 1e-12}}) {
    const auto run = [error = error](benchmark::State& state) {
      EvaluateSumsTo(state, MakeEvaluationPoint("coulomb", StartKind::kRelease), error);
    };
    benchmark::RegisterBenchmark(("sensitivities/max_trace_error:" + std::string(name)).c_str(), run)
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace pendulum::benchmarks
