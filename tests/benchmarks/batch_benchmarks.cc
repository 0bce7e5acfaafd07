// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "pendulum/base/median.h"
#include "pendulum/batch/refit.h"
#include "pendulum/batch/source.h"
#include "pendulum/batch/store.h"
#include "pendulum_benchmarks.h"
#include "reference_run.h"

namespace pendulum::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A folder with `count` copies of the reference run and their manifest, deleted with this object.
class BatchFolder {
 public:
  explicit BatchFolder(int count)
      : folder_(std::filesystem::temp_directory_path() / ("batch_benchmarks_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    const std::string csv = ReferenceCsv();
    std::ofstream manifest(folder_ / "runs.csv");
    manifest << "path\n";
    for (int k = 0; k < count; ++k) {
      const std::string name = "run_" + std::to_string(k) + ".csv";
      std::ofstream(folder_ / name) << csv << "# " << k << '\n';
      manifest << name << '\n';
    }
  }
  BatchFolder(const BatchFolder&) = delete;
  BatchFolder& operator=(const BatchFolder&) = delete;
  ~BatchFolder() { std::filesystem::remove_all(folder_); }

  Source source() const { return Expect(OpenSource(folder_ / "runs.csv")); }

  /// The path of a store that does not exist yet.
  std::filesystem::path NewStore() const {
    std::filesystem::remove(folder_ / "results.sqlite");
    return folder_ / "results.sqlite";
  }

 private:
  std::filesystem::path folder_;
};

/// Time [s] to process the runs of a batch from their files to their JSON, in sequence on one thread.
double FilesToJson(const Source& source, const RefitOptions& options) {
  const Clock::time_point begin = Clock::now();
  const auto fitted = source.for_each([&](const ManifestEntry& entry) -> Result<void> {
    benchmark::DoNotOptimize(RefitRun(source, entry, options).result.dump());
    return {};
  });
  if (!fitted) throw std::runtime_error(fitted.error().message());
  return SecondsSince(begin);
}

/// Refits a batch into a new store on all cores, and the same runs from file to JSON on one thread. The counter
/// share_of_cores is the throughput of the batch divided by that of one thread times the number of cores.
void RefitBatch(benchmark::State& state) {
  constexpr int kRuns = 100;
  const BatchFolder folder(kRuns);
  const Source source = folder.source();
  RefitOptions options;
  options.run.models = {"coulomb"};
  const auto cores = static_cast<double>(std::thread::hardware_concurrency());
  std::vector<double> shares;
  for (auto _ : state) {
    const double alone = FilesToJson(source, options);
    const Clock::time_point begin = Clock::now();
    Store store = Expect(Store::Open(folder.NewStore(), Store::Mode::kWrite));
    const RefitCounts counts = Expect(Refit(source, store, options));
    if (counts.refitted != kRuns || counts.unfitted > 0) return state.SkipWithError("not all runs were fitted");
    shares.push_back(alone / (cores * SecondsSince(begin)));
  }
  state.counters["share_of_cores"] = Median(std::move(shares));
}

}  // namespace

void RegisterBatchBenchmarks() {
  benchmark::RegisterBenchmark("batch/refit", RefitBatch)->Unit(benchmark::kMillisecond)->UseRealTime();
}

}  // namespace pendulum::benchmarks
