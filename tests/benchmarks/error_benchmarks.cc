// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <optional>

#include <benchmark/benchmark.h>

#include "pendulum/fitting/solve/maximum_likelihood.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/search.h"
#include "pendulum/fitting/uncertainty/bootstrap.h"
#include "pendulum/fitting/uncertainty/profile.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"
#include "pendulum/trajectory/tolerance.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

/// The reference run after its fit and before it is judged. The cost refers to the problem.
struct SolvedRun {
  Recording recording = ReferenceRecording();
  FitOptions options;
  std::unique_ptr<FitProblem> problem;
  std::unique_ptr<TrajectoryCost> cost;
  Solution solution;

  SolvedFit Fit() { return SolvedFitOf({recording, options, *problem, *cost, solution}); }
};

SolvedRun SolveReferenceRun() {
  SolvedRun run;
  run.options.rig = ReferenceRig();
  run.problem = std::make_unique<FitProblem>(Expect(MakeFitProblem(run.recording, run.options)));
  const FitProblem& problem = *run.problem;
  run.cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  run.cost->set_tolerance(TraceTolerance(run.options.search.max_trace_error, problem.start.amplitude));
  run.cost->set_noise(problem.noise);
  run.solution = Search(
      *run.cost, problem.data, [&](const auto& fixed) { return FirstGuess(problem, fixed); }, problem.solve);
  MaximizeLikelihood(*run.cost, problem, run.options, run.solution);
  return run;
}

/// Information and its inverse at the optimum, for white residuals: one pass over the samples and some algebra.
void FindCovariance(benchmark::State& state) {
  SolvedRun run = SolveReferenceRun();
  for (auto _ : state) {
    double& last = run.solution.parameters.back();
    last = std::nextafter(last, 1.0);  // the cost caches the sums of the last point
    const std::optional<Optimum> optimum = Linearize(run.problem->solve, *run.cost, run.solution);
    if (!optimum || !optimum->inverse.identifiable) return state.SkipWithError("not identifiable");
    Errors errors = ComputeErrors(run.Fit(), *optimum);
    benchmark::DoNotOptimize(errors.covariance.data());
  }
  state.counters["samples"] = kSamples;
}

/// Profile-likelihood intervals of all free parameters.
void FindProfiles(benchmark::State& state) {
  SolvedRun run = SolveReferenceRun();
  const SolvedFit fit = run.Fit();
  const std::optional<Optimum> optimum = Linearize(run.problem->solve, *run.cost, run.solution);
  if (!optimum) return state.SkipWithError("no trajectory");
  const int before = run.cost->traces();
  for (auto _ : state) {
    for (const int k : optimum->free) {
      const ProfileInterval interval = ProfileParameter(fit, *optimum, k);
      if (!interval.lower || !interval.upper) return state.SkipWithError(std::string(Sentence(interval.open)).c_str());
    }
  }
  state.counters["parameters"] = static_cast<double>(optimum->free.size());
  state.counters["traces"] = benchmark::Counter(run.cost->traces() - before, benchmark::Counter::kAvgIterations);
  state.counters["samples"] = kSamples;
}

/// A fit with bootstrap intervals, on one thread.
void FitWithBootstrap(benchmark::State& state) {
  FitOptions options;
  options.rig = ReferenceRig();
  options.interval = IntervalMethod::kBootstrap;
  options.threads = 1;
  const Recording recording = ReferenceRecording();
  for (auto _ : state) {
    const Result<FitReport> fit = FitRecording(recording, options);
    if (!fit || fit->termination != Termination::kConverged) return state.SkipWithError("not converged");
  }
  state.counters["refits"] = kBootstrapFits;
  state.counters["samples"] = kSamples;
}

}  // namespace

void RegisterErrorBenchmarks() {
  benchmark::RegisterBenchmark("covariance", FindCovariance)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("profile", FindProfiles)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("bootstrap", FitWithBootstrap)->Unit(benchmark::kMillisecond);
}

}  // namespace pendulum::benchmarks
