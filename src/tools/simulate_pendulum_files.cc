// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate_pendulum_files.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/parallel.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/export.h"
#include "pendulum/request/simulation_text.h"
#include "tools/output.h"

namespace pendulum {
namespace {

constexpr int kBlock = 1000;  // Recordings checked in one call; rows written in one call.

int Blocks(int count) { return (count + kBlock - 1) / kBlock; }

/// The outputs of a block of recordings, and the manifest, which must be a different file.
std::vector<NamedFile> OutputsOfBlock(const SimulateOptions& options, int block) {
  std::vector<NamedFile> outputs;
  for (int i = block * kBlock; i < std::min((block + 1) * kBlock, options.count); ++i) {
    for (NamedFile& output : options.Outputs(i)) outputs.push_back(std::move(output));
  }
  if (!options.manifest_out.empty()) outputs.push_back({"--manifest", options.manifest_out});
  return outputs;
}

/// File names contain the recording's number, so two recordings have no file in common.
Result<void> CheckAllOutputs(const SimulateOptions& options) {
  std::vector<NamedFile> inputs;
  if (!options.rig_path.empty()) inputs.push_back({"--rig", options.rig_path});
  for (int block = 0; block < Blocks(options.count); ++block) {
    RETURN_IF_ERROR(CheckOutputs(OutputsOfBlock(options, block), inputs));
  }
  return {};
}

Result<void> WriteRecording(const SimulateOptions& all, int index) {
  ASSIGN_OR_RETURN(const Simulation simulation, SimulationOfRecording(all, index));
  const std::uint64_t seed = simulation.synthetic.seed;
  Result<std::string> csv = SimulatedCsv(simulation, seed);
  if (!csv) {
    return Within(all.count == 1 ? "" : "seed " + std::to_string(seed), csv.error());
  }
  const std::vector<NamedFile> files = all.Outputs(index);
  std::vector<Output> outputs = {{files.front().path, *std::move(csv)}};
  if (files.size() > 1) outputs.push_back({files.back().path, TruthJson(simulation, seed)});
  return WriteOutputs(outputs, all.count == 1 ? Durability::kSynchronised : Durability::kDeferred);
}

/// The error with the smallest index of all errors that the threads report.
class FirstError {
 public:
  explicit FirstError(int count) : index_(count) {}

  int index() const { return index_; }

  void Report(int index, const Status& status) {
    const std::scoped_lock lock(mutex_);
    if (index >= index_) return;
    index_ = index;
    error_ = tl::unexpected(status);
  }

  const Result<void>& error() const { return error_; }

 private:
  std::mutex mutex_;
  std::atomic<int> index_;
  Result<void> error_;
};

/// Recordings are started in the order of their numbers, so all recordings before the first failed one are written,
/// whatever the number of threads.
Result<void> WriteAllRecordings(const SimulateOptions& options) {
  FirstError first(options.count);
  ParallelFor(options.count, options.threads, [&](int index) {
    if (index > first.index()) return;
    if (auto written = WriteRecording(options, index); !written) first.Report(index, written.error());
  });
  return first.error();
}

Result<void> SynchroniseRecordings(const SimulateOptions& options) {
  if (options.count == 1) return {};
  if (auto done = SynchroniseFileSystem(options.out); !done || options.truth_out.empty()) return done;
  return SynchroniseFileSystem(options.truth_out);
}

Result<void> WriteManifest(const SimulateOptions& options) {
  if (options.manifest_out.empty()) return {};
  const Manifest manifest(options);
  return WritePieces(options.manifest_out, Blocks(options.count), [&](int block) -> Result<std::string> {
    std::string rows = block == 0 ? manifest.Header() : "";
    for (int i = block * kBlock; i < std::min((block + 1) * kBlock, options.count); ++i) {
      ASSIGN_OR_RETURN(const std::string row, manifest.Row(i));
      rows += row;
    }
    return rows;
  });
}

namespace fs = std::filesystem;

/// The folder of a file with symbolic links resolved; otherwise ".." in a relative path could lead to another folder.
fs::path RealFolder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;
  const fs::path real = fs::canonical(folder.empty() ? "." : folder, error);
  return error ? fs::absolute(folder, error) : real;
}

/// `folder` relative to `base`: "" for the same folder, otherwise with a slash at its end.
std::string SeenFrom(const fs::path& base, const fs::path& folder) {
  const fs::path relative = folder.lexically_relative(base);
  return relative == "." ? "" : (relative / "").string();
}

}  // namespace

Result<void> WriteRecordings(const SimulateOptions& options) {
  for (const auto step : {CheckAllOutputs, WriteAllRecordings, SynchroniseRecordings, WriteManifest}) {
    RETURN_IF_ERROR(step(options));
  }
  return {};
}

Manifest::Manifest(const SimulateOptions& options) : options_(options) {
  const fs::path base = RealFolder(IsStandardOutput(options.manifest_out) ? "" : options.manifest_out);
  folder_ = SeenFrom(base, RealFolder(options.out));
  if (options.rig_path.empty()) return;
  const std::string name = fs::path(options.rig_path).filename().string();
  rig_ = CsvField(SeenFrom(base, RealFolder(options.rig_path)) + name);
}

std::string Manifest::Header() const {
  std::string header = rig_.empty() ? "path,id,seed" : "path,id,rig,seed";
  for (const auto& [name, value] : options_.truth) header += ",true_" + name;
  return header + "\n";
}

Result<std::string> Manifest::Row(int index) const {
  ASSIGN_OR_RETURN(const Simulation made, SimulationOfRecording(options_, index));
  const fs::path path = NumberedPath(options_.out, index, options_.count);
  std::string row = CsvField(folder_ + path.filename().string()) + "," + CsvField(path.stem().string()) + ",";
  if (!rig_.empty()) row += rig_ + ",";
  row += std::to_string(made.synthetic.seed);
  for (const auto& [name, value] : made.truth) row += "," + NumberText(value);
  return row + "\n";
}

}  // namespace pendulum
