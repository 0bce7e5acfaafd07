// SPDX-License-Identifier: Apache-2.0
#include "tools/refit_commands.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "pendulum/base/file.h"
#include "pendulum/base/json.h"
#include "pendulum/base/staged_file.h"
#include "pendulum/base/try.h"
#include "pendulum/batch/compare_stores.h"
#include "pendulum/batch/export.h"
#include "pendulum/batch/prune.h"
#include "pendulum/batch/store_lock.h"
#include "pendulum/batch/summary_json.h"
#include "pendulum/batch/temporary_store.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/recording/calibration/calibration_source.h"
#include "pendulum/web/summary_page.h"
#include "tools/output.h"
#include "tools/refit_text.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

std::atomic<bool> stop = false;
std::atomic<int> stop_signal = 0;

/// The first signal requests an orderly end: the fits in progress are left for the next refit, and what is done is
/// stored. A second Ctrl-C stops at once, which does not damage the store.
void Stop(int signal) {
  constexpr std::string_view kWords =
      "\nrefit_pendulums: stopping and storing what is done; press Ctrl-C again to stop at once\n";
  if (signal == SIGINT && stop_signal == SIGINT) ::_exit(kInterrupted);
  const int error = errno;
  if (signal == SIGINT) WriteAll(STDERR_FILENO, kWords);
  errno = error;
  stop = true;
  stop_signal = signal;
}

void StopOnSignals() {
  struct sigaction action {};
  action.sa_handler = Stop;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

Result<Source> SourceOf(const RefitPendulumsOptions& options) {
  return options.manifest.empty() ? FindSource(options.patterns) : OpenSource(options.manifest);
}

/// Reads rig and calibration of the whole batch. They must be valid, because otherwise every run would fail.
Result<void> ReadCommon(const RefitPendulumsOptions& options, RefitOptions& refit) {
  if (!options.rig.empty()) {
    ASSIGN_OR_RETURN(auto text, ReadFile(options.rig, "rig", kMaxJsonBytes));
    std::vector<Warning> ignored;  // Each run gives them.
    RETURN_IF_ERROR(ParseRigWith(options.refit.run.rig_values, text, options.rig, ignored));
    refit.rig = std::move(text);
  }
  if (options.calibration.empty()) return {};
  ASSIGN_OR_RETURN(auto text, ReadFile(options.calibration, "calibration", kMaxJsonBytes));
  RETURN_IF_ERROR(CalibrationFromText(text, options.calibration));
  refit.calibration = std::move(text);
  return {};
}

/// A name that is unique among all attempts: job, restart, host, process.
std::string AttemptName() {
  const auto variable = [](const char* name, const char* otherwise) -> std::string {
    const char* value = std::getenv(name);
    return value == nullptr ? otherwise : value;
  };
  constexpr std::size_t kLongest = 256;
  std::string host(kLongest, '\0');
  if (::gethostname(host.data(), host.size() - 1) != 0) host = "host";
  host.resize(host.find('\0') == std::string::npos ? host.size() : host.find('\0'));
  return variable("SLURM_JOB_ID", "0") + "-" + variable("SLURM_RESTART_COUNT", "0") + "-" + host + "-" +
         std::to_string(::getpid());
}

/// Refits directly into the store; this process is its only writer.
Result<RefitCounts> RefitInPlace(const Source& source, const std::string& path, const RefitOptions& options) {
  RETURN_IF_ERROR(CheckFolderOf(path));
  ASSIGN_OR_RETURN(const auto lock, StoreLock::Take(path));
  ASSIGN_OR_RETURN(auto store, Store::Open(path, Store::Mode::kWrite));
  return Refit(source, store, options);
}

Result<int> WriteText(const std::string& text) {
  RETURN_IF_ERROR(WriteOutputs(std::vector<Output>{{"-", text}}));
  return 0;
}

/// Prints the summary of a store, preceded by its details if they are asked for. A store without fits has details only.
Result<int> ShowStatus(const RefitPendulumsOptions& options) {
  const std::string& path = options.stores.front();
  ASSIGN_OR_RETURN(auto store, Store::Open(path, Store::Mode::kRead));
  ASSIGN_OR_RETURN(const auto counts, store.Count());
  const bool has_fits = counts.fits > 0;
  std::string text;
  if (options.details || !has_fits) {
    ASSIGN_OR_RETURN(const auto details, StatusText(store));
    text = details;
  }
  if (!has_fits) return WriteText(options.quiet ? "" : text);
  SummaryOptions how = options.summary;
  how.main_law_only = how.without_runs = true;
  how.without_agreement = options.quiet;
  ASSIGN_OR_RETURN(const auto summary, Summarize(store, how));
  return WriteText(options.quiet ? QuietText(summary) : text + SummaryText(summary, path));
}

/// The counts of the runs in a store.
Result<StoreCounts> CountRunsOf(const std::string& path) {
  ASSIGN_OR_RETURN(auto store, Store::Open(path, Store::Mode::kRead));
  return store.Count();
}

/// Prints the summary of a refit and returns its exit code.
Result<int> FinishRefit(const RefitCounts& counts, const RefitPendulumsOptions& options) {
  if (counts.stopped) {
    PrintMessage(kRefitToolName, RefitText(counts) + "; " + std::to_string(counts.runs - counts.done()) +
                                     " are left; run the same command to continue" +
                                     (options.refit.force ? ", without --force" : ""));
    return stop_signal == SIGINT ? kInterrupted : ExitCode(StatusCode::kTryAgain);
  }
  ASSIGN_OR_RETURN(const auto stored, CountRunsOf(options.stores.front()));
  PrintMessage(kRefitToolName, RefitText(counts) + WithoutResultText(stored));
  const auto shown = ShowStatus(options);
  // The merge reports for all shards; their jobs have done what they could.
  const bool is_fault = stored.lacks_results() && !options.refit.shard;
  return shown && is_fault ? ExitCode(StatusCode::kNotFound) : shown;
}

Result<int> RunRefit(const RefitPendulumsOptions& options) {
  RefitOptions refit = options.refit;
  refit.group_by = options.summary.group_by;
  RETURN_IF_ERROR(ReadCommon(options, refit));
  ASSIGN_OR_RETURN(const auto source, SourceOf(options));
  if (!source.left_out.empty()) PrintMessage(kRefitToolName, LeftOutText(source.left_out));
  if (!source.lists.empty()) PrintMessage(kRefitToolName, ListsText(source.lists));
  StopOnSignals();
  RefitProgress progress(std::string(kRefitToolName), STDERR_FILENO);
  refit.stop = &stop;
  refit.progress = [&](const RefitCounts& counts) { progress.Show(counts); };
  const std::string& store = options.stores.front();
  ShardOptions shard = options.shard;
  shard.attempt = AttemptName();
  const auto counts = refit.shard ? RefitShard(source, shard, refit) : RefitInPlace(source, store, refit);
  progress.Finish();
  if (!counts) return tl::unexpected(counts.error());
  return FinishRefit(*counts, options);
}

/// Opens the store for reading, after a check that --out can be written and is not the store.
Result<Store> OpenForOutput(const RefitPendulumsOptions& options) {
  const std::string& store = options.stores.front();
  const std::vector<NamedFile> outputs = {{"--out", options.out}}, inputs = {{"--store", store}};
  RETURN_IF_ERROR(CheckOutputs(outputs, inputs));
  return Store::Open(store, Store::Mode::kRead);
}

Result<int> RunExport(const RefitPendulumsOptions& options) {
  const std::string& out = options.out;
  const bool lines = out.ends_with(".jsonl") || out.ends_with(".ndjson");
  if (!lines && !out.ends_with(".csv") && !IsStandardOutput(out)) {
    return Error(
        StatusCode::kInvalidArgument,
        "--out " + out +
            ": the name must end with .csv for a table or .jsonl for JSON lines; - is the table on standard output");
  }
  ASSIGN_OR_RETURN(auto store, OpenForOutput(options));
  RETURN_IF_ERROR(WriteStreamed(
      out, [&](const TextSink& take) { return lines ? ExportJsonLines(store, take) : ExportCsv(store, take); }));
  return 0;
}

Result<int> MakeReport(const RefitPendulumsOptions& options) {
  const bool json = options.out.ends_with(".json");
  if (!json && !options.out.ends_with(".html") && !IsStandardOutput(options.out)) {
    return Error(
        StatusCode::kInvalidArgument,
        "--out " + options.out +
            ": the name must end with .html for a page or .json for its data; - is the page on standard output");
  }
  ASSIGN_OR_RETURN(auto store, OpenForOutput(options));
  ASSIGN_OR_RETURN(const auto summary, Summarize(store, options.summary));
  const auto summary_json = ToJson(summary);
  const std::string text = json ? JsonText(summary_json, 2) + "\n" : SummaryHtml(summary_json);
  RETURN_IF_ERROR(WriteOutputs(std::vector<Output>{{options.out, text}}));
  return 0;
}

Result<int> RunCompare(const RefitPendulumsOptions& options) {
  ASSIGN_OR_RETURN(auto before, Store::Open(options.stores[0], Store::Mode::kRead));
  ASSIGN_OR_RETURN(auto after, Store::Open(options.stores[1], Store::Mode::kRead));
  ASSIGN_OR_RETURN(const auto comparison, CompareStores(before, after));
  RETURN_IF_ERROR(WriteText(ComparisonText(comparison, options.stores[0], options.stores[1])));
  return comparison.moved + comparison.changed_status + comparison.only_before > 0 ? 1 : 0;
}

Result<int> RunPack(const RefitPendulumsOptions& options) {
  ASSIGN_OR_RETURN(const auto source, SourceOf(options));
  std::vector<NamedFile> inputs;
  if (!options.manifest.empty()) inputs.push_back({"--manifest", options.manifest});
  RETURN_IF_ERROR(CheckOutputs(std::vector<NamedFile>{{"--out", options.out}}, inputs));
  ASSIGN_OR_RETURN(const auto packed, Pack(source, options.out));
  if (packed.unreadable > 0) {
    PrintMessage(kRefitToolName,
                 std::to_string(packed.unreadable) + " of " + std::to_string(packed.files) +
                     " files could not be read, and the pack records that; the first: " + packed.first_reason);
  }
  return 0;
}

Result<int> RunPrune(const RefitPendulumsOptions& options) {
  const std::string& path = options.stores.front();
  auto store = Store::Open(path, Store::Mode::kRead);
  if (!store) return tl::unexpected(store.error());
  auto prunable = FindPrunable(*store);
  if (!prunable) return tl::unexpected(prunable.error());
  if (options.dry_run) return WriteText(PruneText(*prunable, true));
  ASSIGN_OR_RETURN(const auto lock, StoreLock::Take(path));
  store = Store::Open(path, Store::Mode::kWrite);
  if (store) prunable = Prune(*store);
  if (!store || !prunable) return tl::unexpected(store ? prunable.error() : store.error());
  return WriteText(PruneText(*prunable, false));
}

Result<int> RunMissing(const RefitPendulumsOptions& options) {
  ASSIGN_OR_RETURN(const auto missing, MissingShards(options.shard_dir, options.shard_count));
  if (missing.empty()) return 0;
  return WriteText(ShardList(missing) + "\n");
}

Result<int> RunMerge(const RefitPendulumsOptions& options) {
  const std::string& path = options.stores.front();
  const auto runs = MergeShards(options.shard_dir, options.shard_count, path);
  if (!runs) return tl::unexpected(runs.error());
  ASSIGN_OR_RETURN(const auto counts, CountRunsOf(path));
  PrintMessage(kRefitToolName, std::to_string(*runs) + " runs of " + std::to_string(options.shard_count) +
                                   " shards merged into " + path + KeptText(counts.stale) + WithoutResultText(counts));
  return counts.lacks_results() ? ExitCode(StatusCode::kNotFound) : 0;
}

}  // namespace

Result<int> RunRefitCommand(const RefitPendulumsOptions& options) {
  switch (options.command) {
    case RefitCommand::kRefit: return RunRefit(options);
    case RefitCommand::kStatus: return ShowStatus(options);
    case RefitCommand::kExport: return RunExport(options);
    case RefitCommand::kCompare: return RunCompare(options);
    case RefitCommand::kReport: return MakeReport(options);
    case RefitCommand::kPack: return RunPack(options);
    case RefitCommand::kPrune: return RunPrune(options);
    case RefitCommand::kMissing: return RunMissing(options);
    case RefitCommand::kMerge: return RunMerge(options);
  }
  return ExitCode(StatusCode::kInternal);
}

}  // namespace pendulum
