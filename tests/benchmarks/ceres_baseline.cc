// SPDX-License-Identifier: Apache-2.0
#include "ceres_baseline.h"

#include <cstddef>
#include <vector>

#include <ceres/problem.h>

namespace pendulum::benchmarks {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

EvaluationPoint PointAt(const Parameters& parameters) {
  EvaluationPoint point = MakeEvaluationPoint("coulomb", StartKind::kRelease);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    point.parameters[i] = parameters[i] / point.problem.si_per_internal[i];
  }
  return point;
}

}  // namespace

Parameters OurStartValues() {
  const FitProblem problem = MakeEvaluationPoint("coulomb", StartKind::kRelease).problem;
  Parameters start{};
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = problem.first_guess[i] * problem.si_per_internal[i];
  return start;
}

CeresSolution SolveByCeres(ceres::CostFunction& cost, const Parameters& start) {
  CeresSolution solution{start, {}};
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  problem.AddResidualBlock(&cost, nullptr, solution.parameters.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  ceres::Solve(options, &problem, &solution.summary);
  return solution;
}

double MaxTrajectoryError(const ceres::CostFunction& cost, const Parameters& parameters) {
  Eigen::VectorXd residuals(kSamples);
  const double* block = parameters.data();
  cost.Evaluate(&block, residuals.data(), nullptr);
  return MaxReadingError(PointAt(parameters), ReferenceRecording().value - residuals);
}

void TimeEvaluation(benchmark::State& state, const ceres::CostFunction& cost, bool with_jacobian) {
  const double* block = kTruth.data();
  std::vector<double> residuals(kSamples);
  RowMajor jacobian(kSamples, kTruth.size());
  double* jacobian_block = jacobian.data();
  for (auto _ : state) {
    const bool valid = cost.Evaluate(&block, residuals.data(), with_jacobian ? &jacobian_block : nullptr);
    if (!valid) return state.SkipWithError("no trajectory");
    benchmark::DoNotOptimize(residuals.data());
    benchmark::DoNotOptimize(jacobian.data());
    benchmark::ClobberMemory();
  }
  state.counters["max_error_rad"] = MaxTrajectoryError(cost, kTruth);
  if (with_jacobian) state.counters["max_jacobian_error"] = MaxJacobianError(PointAt(kTruth), -jacobian);
  state.counters["samples"] = kSamples;
}

void TimeSolve(benchmark::State& state, ceres::CostFunction& cost, const Parameters& start) {
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

}  // namespace pendulum::benchmarks
