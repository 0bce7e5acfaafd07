// SPDX-License-Identifier: Apache-2.0
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "pendulum/analysis/coverage_scenarios.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/base/median.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "pendulum/trajectory/synthetic.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

/// Processor time of this thread [s], which other programs on the machine do not affect.
double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Recordings of 2000 samples of one rig, released from 0.7 to 1.3 times the scenario's angle.
std::vector<Recording> RecordingsOf(const CoverageScenario& scenario, int count) {
  std::vector<Recording> recordings;
  for (int k = 0; k < count; ++k) {
    SyntheticOptions run = ScenarioRun(scenario, static_cast<std::uint64_t>(k + 1));
    run.release_angle *= 0.7 + 0.6 * k / (count - 1);
    recordings.push_back(Expect(SimulateRecording(run)));
  }
  return recordings;
}

/// All separate fits and the joint fit, on one thread. The counter times_one is their processor time divided by the
/// mean time of a separate fit.
void FitTogether(benchmark::State& state, const std::string& name, int count) {
  const CoverageScenario scenario = Expect(FindCoverageScenarios(name)).front();
  const std::vector<Recording> recordings = RecordingsOf(scenario, count);
  const std::vector<std::string> shared = PhysicalNames({scenario.fit.model});
  std::vector<double> ratios;
  for (auto _ : state) {
    const double begin = CpuSeconds();
    std::vector<FitReport> alone;
    for (const Recording& recording : recordings) alone.push_back(Expect(FitRecording(recording, scenario.fit)));
    const double one = (CpuSeconds() - begin) / count;
    std::vector<JointRun> runs;
    for (std::size_t k = 0; k < alone.size(); ++k) runs.push_back({recordings[k], alone[k], scenario.fit});
    const Result<JointFit> fit = FitJointly(runs, shared);
    if (!fit || fit->whole.termination != Termination::kConverged) return state.SkipWithError("not converged");
    ratios.push_back((CpuSeconds() - begin) / one);
  }
  state.counters["times_one"] = Median(std::move(ratios));
  state.counters["recordings"] = count;
}

}  // namespace

void RegisterJointBenchmarks() {
  for (const std::string scenario : {"white_2.5", "white_0.5"}) {
    for (const int count : {2, 5, 20, 100}) {
      benchmark::RegisterBenchmark(("fit_jointly/" + scenario + "/recordings:" + std::to_string(count)).c_str(),
                                   FitTogether, scenario, count)
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace pendulum::benchmarks
