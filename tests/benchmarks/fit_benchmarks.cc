// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "pendulum/fitting/start/start_values.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/identify/identify.h"
#include "pendulum/identify/identify_options.h"
#include "pendulum/identify/prepared_recording.h"
#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/repair_values.h"
#include "pendulum/report/json.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

FitOptions ReferenceOptions() {
  FitOptions options;
  options.rig = ReferenceRig();
  options.threads = 1;  // except in benchmarks of threads
  return options;
}

void Report(benchmark::State& state, const FitReport& fit) {
  Parameters estimates;
  for (std::size_t i = 0; i < estimates.size(); ++i) estimates[i] = fit.parameters[i].estimate;
  state.counters["std_errors_from_optimum"] = DistanceFromOptimum(estimates);
  state.counters["max_error_rad"] = fit.trace_error;
  state.counters["iterations"] = fit.solver.iterations;
  state.counters["samples"] = static_cast<double>(fit.residual.size());
}

void FindStartValues(benchmark::State& state) {
  const Recording recording = ReferenceRecording();
  const MotionModel model = Expect(FindMotionModel("coulomb"));
  for (auto _ : state) {
    Result<StartValues> values = EstimateStartValues(recording, model, std::nullopt);
    if (!values) return state.SkipWithError(values.error().message().c_str());
    benchmark::DoNotOptimize(values);
  }
}

/// Repairs the values and finds the free swing.
void FindWindow(benchmark::State& state) {
  const Recording recording = ReferenceRecording();
  for (auto _ : state) {
    const Recording repaired = RepairValues(recording);
    Result<ChosenSwings> swings = ChooseSwings(repaired, {});
    if (!swings) return state.SkipWithError(swings.error().message().c_str());
    benchmark::DoNotOptimize(swings);
  }
  state.counters["samples"] = kSamples;
}

/// From raw samples to estimates, sigma and covariance.
void FitAgain(benchmark::State& state, const Recording& recording, const FitOptions& options) {
  Result<FitReport> fit;
  for (auto _ : state) {
    fit = FitRecording(recording, options);
    if (!fit) return state.SkipWithError(fit.error().message().c_str());
    if (fit->termination != Termination::kConverged) return state.SkipWithError(fit->reason.c_str());
  }
  Report(state, *fit);
}

void Fit(benchmark::State& state, int samples) {
  FitAgain(state, ReferenceRecording(samples), ReferenceOptions());
  // Only the reference run's optimum is known.
  if (samples != kSamples) state.counters.erase("std_errors_from_optimum");
}

/// The same readings with noise of `counts` counts, treated as continuous or as quantized.
void FitCounts(benchmark::State& state, double counts, std::optional<NoiseFamily> noise) {
  FitOptions options = ReferenceOptions();
  options.noise = noise;
  FitAgain(state, ReferenceRecording(kSamples, counts), options);
  state.counters.erase("std_errors_from_optimum");
}

void ParseCsv(benchmark::State& state) {
  const std::string csv = ReferenceCsv();
  for (auto _ : state) {
    Result<Recording> recording = ParseRecording(csv, "reference.csv");
    if (!recording) return state.SkipWithError(recording.error().message().c_str());
    benchmark::DoNotOptimize(recording);
  }
  state.counters["samples"] = kSamples;
}

/// A temporary file, deleted with this object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("pendulum_benchmarks_" + std::to_string(getpid()) + ".csv")) {
    std::ofstream(path_) << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The result of fit_pendulum with these laws.
Result<Identification> FitFile(const std::filesystem::path& path, const std::vector<std::string>& models,
                               Checks checks) {
  IdentifyOptions options;
  options.models = models;
  options.checks = checks;
  options.fit = ReferenceOptions();
  options.fit.model = models.front();
  auto prepared = PrepareFile(path.string(), options, options.fit.rig);
  if (!prepared) return tl::unexpected(prepared.error());
  return std::move(IdentifyEach(options, *std::move(prepared)).front());
}

/// Reads, repairs, selects the window, fits and writes JSON, without closed forms, checks and constancy.
void FileToJson(benchmark::State& state) {
  const TemporaryFile file(ReferenceCsv());
  Result<Identification> report;
  for (auto _ : state) {
    report = FitFile(file.path(), {ReferenceOptions().model}, Checks::kNone);
    if (!report) return state.SkipWithError(report.error().message().c_str());
    std::string json = ToJsonText(*report);
    benchmark::DoNotOptimize(json);
  }
  Report(state, report->fits.front());
}

/// The complete default result of fit_pendulum for a file, from reading to JSON.
void FileToResult(benchmark::State& state, const std::vector<std::string>& models) {
  const TemporaryFile file(ReferenceCsv());
  for (auto _ : state) {
    const auto report = FitFile(file.path(), models, Checks::kStandard);
    if (!report) return state.SkipWithError(report.error().message().c_str());
    std::string json = ToJsonText(*report);
    benchmark::DoNotOptimize(json);
  }
}

/// Writes the report only.
void WriteJson(benchmark::State& state) {
  const TemporaryFile file(ReferenceCsv());
  const Identification report = Expect(FitFile(file.path(), {ReferenceOptions().model}, Checks::kNone));
  std::size_t bytes = 0;
  for (auto _ : state) {
    std::string json = ToJsonText(report);
    bytes = json.size();
    benchmark::DoNotOptimize(json);
  }
  state.counters["bytes"] = static_cast<double>(bytes);
}

}  // namespace

void RegisterFitBenchmarks() {
  benchmark::RegisterBenchmark("start_values", FindStartValues)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("find_window", FindWindow)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("fit", Fit, kSamples)->Unit(benchmark::kMicrosecond);
  for (const auto& [name, counts] : {std::pair{"0.5", 0.5}, std::pair{"0.25", 0.25}}) {
    for (const std::optional<NoiseFamily> noise : {NoiseFamily::kGaussian, NoiseFamily::kQuantized}) {
      const std::string family = noise == NoiseFamily::kGaussian ? "gaussian" : "quantized";
      benchmark::RegisterBenchmark(("fit/counts:" + std::string(name) + "/" + family).c_str(), FitCounts, counts, noise)
          ->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::RegisterBenchmark("parse_csv", ParseCsv)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("file_to_json", FileToJson)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("file_to_result/coulomb", FileToResult, std::vector<std::string>{"coulomb"})
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("file_to_result/all", FileToResult,
                               std::vector<std::string>{"viscous", "coulomb", "drag", "stribeck"})
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("json", WriteJson)->Unit(benchmark::kMicrosecond);
  for (const int samples : {1'000, 10'000, 100'000, 1'000'000}) {
    benchmark::RegisterBenchmark(("fit/samples:" + std::to_string(samples)).c_str(), Fit, samples)
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace pendulum::benchmarks
