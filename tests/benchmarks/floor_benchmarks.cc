// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "floor_kernel.h"
#include "pendulum/model/dual.h"
#include "pendulum/model/friction/coulomb.h"
#include "pendulum/trajectory/tolerance.h"
#include "pendulum/trajectory/trajectory.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

using Dual = pendulum::Dual<4>;  // by inertia, viscous, coulomb, release_angle

/// The samples, and all quantities that can be computed once before they are evaluated.
struct FloorRun {
  EvaluationPoint point;
  double tolerance = 0;        // rad, local
  std::vector<double> values;  // N, rad, without the zero
  std::vector<FloorSegment> segments;

  FloorSamples samples() const { return {point.problem.data.time.data(), values.data()}; }
};

FloorSegment TakeDown(const Segment<Dual>& segment, const std::vector<double>& time, int first) {
  FloorSegment floor;
  floor.start = segment.start;
  floor.order = segment.order;
  floor.first = floor.last = first;
  while (floor.last < static_cast<int>(time.size()) && time[floor.last] < segment.end) ++floor.last;
  for (int k = 0; k <= segment.order; ++k) {
    auto& row = floor.coefficient[k];
    row[0] = segment.angle[k];
    for (int i = 0; i < 4; ++i) row[1 + i] = PartialsAtFixedTime(segment, k)[i];
    row[5] = k < segment.order ? -(k + 1) * segment.angle[k + 1] : 0.0;
  }
  return floor;
}

FloorRun MakeFloorRun(int samples) {
  FloorRun run{MakeEvaluationPoint("coulomb", StartKind::kRelease, samples), 0, {}, {}};
  const TrajectoryData& data = run.point.problem.data;
  const std::vector<double>& p = run.point.parameters;
  run.tolerance = TraceTolerance(FitOptions().search.max_trace_error, run.point.problem.start.amplitude);
  for (const double value : data.value) run.values.push_back(value - p[5]);
  const Pendulum<CoulombFriction, Dual> pendulum{Gravity::kSine, Dual(p[0], 0), {Dual(p[1], 1), Dual(p[2], 2)}};
  const Start<Dual> start{StartKind::kRelease, p[4], Dual(p[3], 3), Dual(0.0)};
  TraceOptions options;
  options.end = std::nextafter(data.time.back(), std::numeric_limits<double>::infinity());
  options.tolerance = run.tolerance;
  const SegmentVisitor<Dual> take = [&](const Segment<Dual>& segment) {
    const int first = run.segments.empty() ? 0 : run.segments.back().last;
    const FloorSegment floor = TakeDown(segment, data.time, first);
    if (floor.last > first) run.segments.push_back(floor);
  };
  TraceTrajectory(pendulum, start, options, take);
  return run;
}

/// Largest difference from TrajectoryCost's sums; a product of two columns is measured relative to their norms.
double FloorDisagreement(const FloorRun& run, const NormalMatrix& floor) {
  const FitProblem& problem = run.point.problem;
  const auto cost = MakeTrajectoryCost(problem.model, problem.start.start, problem.data);
  cost->set_tolerance(run.tolerance);
  Eigen::MatrixXd sums;
  if (!cost->Sums(run.point.parameters, &sums)) return kUnbounded;
  double difference = 0;
  for (int i = 0; i < kNormalSize; ++i) {
    for (int j = 0; j < kNormalSize; ++j) {
      // Residuals decrease where readings increase.
      const double sign = (i == kNormalSize - 1) == (j == kNormalSize - 1) ? 1 : -1;
      const double scaled = sign * floor[i][j] / (problem.data.scale * problem.data.scale);
      difference = std::max(difference, std::abs(scaled - sums(i, j)) / std::sqrt(sums(i, i) * sums(j, j)));
    }
  }
  return difference;
}

/// Checks the kernel's sums, so that a fast kernel with wrong sums is not accepted.
void ReportFloor(benchmark::State& state, const FloorRun& run, const NormalMatrix& matrix, FloorTarget target) {
  constexpr double kLargest = 1e-6;
  if (!(FloorDisagreement(run, matrix) <= kLargest)) return state.SkipWithError("sums are not those of TrajectoryCost");
  state.counters["samples"] = static_cast<double>(run.values.size());
  state.counters["order"] = run.segments.back().order;
  state.counters["segments"] = static_cast<double>(run.segments.size());
  state.counters["lanes"] = target == FloorTarget::kAvx512 ? 8 : target == FloorTarget::kAvx2 ? 4 : 2;
}

void EvaluateTrajectoryFloor(benchmark::State& state, int samples, FloorTarget target) {
  const FloorRun run = MakeFloorRun(samples);
  double sum = 0;
  for (auto _ : state) {
    sum = FloorSumOfSquares(run.segments, run.samples(), target);
    benchmark::DoNotOptimize(sum);
    benchmark::ClobberMemory();
  }
  NormalMatrix matrix = FloorNormalMatrix(run.segments, run.samples(), target);
  matrix[kNormalSize - 1][kNormalSize - 1] = sum;
  ReportFloor(state, run, matrix, target);
}

void EvaluateSensitivitiesFloor(benchmark::State& state, int samples, FloorTarget target) {
  const FloorRun run = MakeFloorRun(samples);
  NormalMatrix matrix{};
  for (auto _ : state) {
    matrix = FloorNormalMatrix(run.segments, run.samples(), target);
    benchmark::DoNotOptimize(matrix);
    benchmark::ClobberMemory();
  }
  ReportFloor(state, run, matrix, target);
}

void RegisterFloor(const std::string& suffix, int samples, FloorTarget target) {
  benchmark::RegisterBenchmark(("floor/trajectory" + suffix).c_str(), EvaluateTrajectoryFloor, samples, target)
      ->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark(("floor/sensitivities" + suffix).c_str(), EvaluateSensitivitiesFloor, samples, target)
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace

void RegisterFloorBenchmarks() {
  const FloorTarget best = BestFloorTarget();
  RegisterFloor("", kSamples, best);
  for (const int samples : {1'000, 10'000, 100'000, 1'000'000}) {
    RegisterFloor("/samples:" + std::to_string(samples), samples, best);
  }
  RegisterFloor("/portable", kSamples, FloorTarget::kPortable);
  RegisterFloor("/portable/samples:1000000", 1'000'000, FloorTarget::kPortable);
}

}  // namespace pendulum::benchmarks
