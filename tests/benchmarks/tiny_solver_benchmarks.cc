// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <span>

#include <benchmark/benchmark.h>
#include <ceres/tiny_solver.h>

#include "ceres_baseline.h"
#include "pendulum/trajectory/tolerance.h"
#include "pendulum_benchmarks.h"

namespace pendulum::benchmarks {
namespace {

/// Residuals of all samples, (measured - modelled) / noise, and their Jacobian by this library's trajectory, in the
/// form that ceres::TinySolver needs. Parameters in units of the restoring torque G.
class TinyResiduals {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 6 };

  explicit TinyResiduals(const FitProblem& problem)
      : data_(problem.data), cost_(MakeTrajectoryCost(problem.model, problem.start.start, problem.data)) {
    cost_->set_tolerance(TraceTolerance(FitOptions().search.max_trace_error, problem.start.amplitude));
  }

  int NumResiduals() const { return static_cast<int>(data_.value.size()); }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const std::span<const double> p(parameters, NUM_PARAMETERS);
    if (!cost_->Readings(p, &readings_, jacobian == nullptr ? nullptr : &derivatives_)) return false;
    const double weight = 1 / data_.scale;
    Eigen::Map<Eigen::VectorXd>(residuals, NumResiduals()) = weight * (data_.values() - readings_);
    if (jacobian != nullptr) {
      Eigen::Map<Eigen::MatrixXd>(jacobian, NumResiduals(), NUM_PARAMETERS) = -weight * derivatives_;
    }
    return true;
  }

 private:
  const TrajectoryData& data_;
  std::unique_ptr<TrajectoryCost> cost_;
  mutable Eigen::VectorXd readings_;
  mutable Eigen::MatrixXd derivatives_;
};

using TinySolver = ceres::TinySolver<TinyResiduals>;

void SolveTiny(benchmark::State& state, const Parameters& start) {
  EvaluationPoint point = MakeEvaluationPoint("coulomb", StartKind::kRelease);
  const auto scale = Eigen::Map<const Eigen::VectorXd>(point.problem.si_per_internal.data(), start.size());
  const TinyResiduals residuals(point.problem);
  TinySolver solver;
  Eigen::VectorXd estimates;
  for (auto _ : state) {
    TinySolver::Parameters parameters =
        Eigen::Map<const Eigen::VectorXd>(start.data(), start.size()).cwiseQuotient(scale);
    solver.Solve(residuals, &parameters);
    if (solver.summary.status == TinySolver::HIT_MAX_ITERATIONS) return state.SkipWithError("not converged");
    estimates = parameters;
  }
  Eigen::VectorXd readings(residuals.NumResiduals());
  residuals(estimates.data(), readings.data(), nullptr);
  readings = point.problem.data.values() - point.problem.data.scale * readings;
  point.parameters.assign(estimates.begin(), estimates.end());
  Parameters si;
  Eigen::Map<Eigen::VectorXd>(si.data(), si.size()) = estimates.cwiseProduct(scale);
  state.counters["std_errors_from_optimum"] = DistanceFromOptimum(si);
  state.counters["max_error_rad"] = MaxReadingError(point, readings);
  state.counters["iterations"] = solver.summary.iterations;
  state.counters["samples"] = kSamples;
}

}  // namespace

void RegisterTinySolverBenchmarks() {
  benchmark::RegisterBenchmark("tiny_solver/solve", SolveTiny, kGuess)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("tiny_solver/solve_from_our_start", [](benchmark::State& state) {
    SolveTiny(state, OurStartValues());
  })->Unit(benchmark::kMicrosecond);
}

}  // namespace pendulum::benchmarks
