// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/refit.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/parallel.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/time_limit.h"
#include "pendulum/base/try.h"
#include "pendulum/base/version.h"
#include "pendulum/batch/provenance.h"
#include "pendulum/batch/summary.h"
#include "pendulum/identify/identify.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/report/json.h"

namespace pendulum {
namespace {

/// The files of a run, if they could be read, and its options.
struct RunInputs {
  Result<std::string> data;
  Result<std::optional<std::string>> rig, calibration;  ///< std::nullopt: none.
  std::string rig_name, calibration_name;
  Result<IdentifyOptions> options;
};

Result<std::optional<std::string>> ReadNamed(const Source& source, const std::string& path,
                                             const std::optional<std::string>& otherwise) {
  if (path.empty()) return otherwise;
  ASSIGN_OR_RETURN(auto bytes, source.read(path));
  return bytes;
}

/// The options of a run: the batch's options with the changes of its entry. Runs are parallel, so each fit uses one
/// thread. kInvalidArgument: the entry's models contradict the batch's law of gravity.
Result<IdentifyOptions> OptionsOf(const ManifestEntry& entry, const IdentifyOptions& batch) {
  IdentifyOptions options = batch;
  options.fit.threads = 1;
  if (entry.from) options.swing.from = *entry.from;
  if (entry.to) options.swing.to = *entry.to;
  if (entry.models.empty()) return options;
  const auto models = FindMotionModels(entry.models, batch.fit.gravity);
  if (!models)
    return ErrorAt(StatusCode::kInvalidArgument, entry.path, "models in the manifest: " + models.error().message());
  options.models.clear();
  for (const MotionModel& model : *models) options.models.emplace_back(model.name);
  options.fit.model = options.models.front();
  options.swing.is_spring =
      std::ranges::all_of(*models, [](const MotionModel& model) { return model.gravity.is_linear(); });
  return options;
}

RunInputs ReadInputs(const Source& source, const ManifestEntry& entry, const RefitOptions& options) {
  return {source.read(entry.path),
          ReadNamed(source, entry.rig, options.rig),
          ReadNamed(source, entry.calibration, options.calibration),
          entry.rig.empty() ? "--rig" : entry.rig,
          entry.calibration.empty() ? "--calibration" : entry.calibration,
          OptionsOf(entry, options.run)};
}

/// Stands for the hash of an unreadable file. While the error stays the same, the run is not tried again.
std::string Unreadable(const Status& status) { return "unreadable: " + status.message(); }

Result<std::string> HashOf(const Result<std::string>& bytes) {
  if (!bytes) return Unreadable(bytes.error());
  return Sha256(*bytes);
}

Result<std::string> HashOf(const Result<std::optional<std::string>>& bytes) {
  if (!bytes) return Unreadable(bytes.error());
  return *bytes ? Sha256(**bytes) : std::string();
}

/// What an attempt was made with, as one hash; empty if that is unknown.
std::string AttemptOf(const Provenance& provenance) {
  if (provenance.version.empty()) return "";
  return Sha256(JsonText({provenance.data_sha256, provenance.rig_sha256, provenance.calibration_sha256,
                          provenance.options_sha256, provenance.version}))
      .value_or("");
}

/// The provenance of a run that was given up after this time: more time may give it a result.
Provenance GivenUp(Provenance provenance, std::chrono::milliseconds limit) {
  provenance.options_sha256 = Sha256(provenance.options_sha256 + std::to_string(limit.count())).value_or("");
  return provenance;
}

/// The names of a run's files, which appear in its result and reasons.
std::string PathsOf(const ManifestEntry& entry) { return JsonText({entry.path, entry.rig, entry.calibration, 0}); }

Result<Provenance> ProvenanceOf(const ManifestEntry& entry, const RunInputs& inputs) {
  if (!inputs.options) return tl::unexpected(inputs.options.error());
  Provenance provenance;
  provenance.version = std::string(kVersion);
  provenance.cpu = CpuType();
  const auto set = [](Result<std::string> hash, std::string& text) -> Result<void> {
    if (!hash) return tl::unexpected(hash.error());
    text = *std::move(hash);
    return {};
  };
  auto done = set(HashOf(inputs.data), provenance.data_sha256);
  if (done) done = set(HashOf(inputs.rig), provenance.rig_sha256);
  if (done) done = set(HashOf(inputs.calibration), provenance.calibration_sha256);
  if (done) done = set(Sha256(OptionsJson(*inputs.options) + PathsOf(entry)), provenance.options_sha256);
  if (!done) return tl::unexpected(done.error());
  return provenance;
}

SharedFile Named(const std::string& name, std::optional<std::string> bytes) {
  return bytes ? Share({name, *std::move(bytes)}) : nullptr;
}

Result<Identification> FitInputs(const ManifestEntry& entry, RunInputs& inputs) {
  if (!inputs.data) return tl::unexpected(inputs.data.error());
  if (!inputs.rig) return tl::unexpected(inputs.rig.error());
  if (!inputs.calibration) return tl::unexpected(inputs.calibration.error());
  return IdentifyBytes(*inputs.options, {{entry.path, *std::move(inputs.data)},
                                         Named(inputs.rig_name, *std::move(inputs.rig)),
                                         Named(inputs.calibration_name, *std::move(inputs.calibration))});
}

std::string TooLong(std::chrono::milliseconds limit) {
  const double seconds = std::chrono::duration<double>(limit).count();
  return "the fit took longer than " + NumberText(seconds, 4) +
         " s; look at the recording with fit_pendulum, shorten it (from_s and to_s in the manifest), or give more time "
         "with --fit_seconds";
}

/// `limit`: of the fit's time; nullptr: none.
RunOutcome OutcomeOf(const ManifestEntry& entry, RunInputs& inputs, Provenance provenance, TimeLimit* limit) {
  RunOutcome outcome;
  outcome.provenance = std::move(provenance);
  outcome.models = inputs.options->models;
  std::optional<TimeLimit::Watch> watch;
  if (limit != nullptr) inputs.options->fit.stop = watch.emplace(*limit).token();
  const Result<Identification> run = FitInputs(entry, inputs);
  if (run) {
    outcome.exit_code = ExitCode(*run);
    outcome.result = ToJson(*run);
  } else {
    outcome.exit_code = ExitCode(run.error().code);
    outcome.reason = ReasonOf(run.error());
    const bool is_stopped = watch && watch->token().stop_requested() && run.error().code == StatusCode::kTryAgain;
    if (is_stopped) {
      outcome.reason = {entry.path, TooLong(limit->limit())};
      outcome.provenance = GivenUp(std::move(outcome.provenance), limit->limit());
    }
  }
  return outcome;
}

RunOutcome Failure(const ManifestEntry& entry, const RefitOptions& options, const Status& status) {
  RunOutcome outcome;
  const auto run = OptionsOf(entry, options.run);
  outcome.models = (run ? *run : options.run).models;
  outcome.exit_code = ExitCode(status.code);
  outcome.reason = ReasonOf(status);
  return outcome;
}

/// The outcome of a run; std::nullopt if its provenance is current.
template <typename IsCurrent>
std::optional<RunOutcome> RefitUnless(const Source& source, const ManifestEntry& entry, const RefitOptions& options,
                                      const IsCurrent& is_current, TimeLimit* limit = nullptr) {
  RunInputs inputs = ReadInputs(source, entry, options);
  auto provenance = ProvenanceOf(entry, inputs);
  if (!provenance) return Failure(entry, options, provenance.error());
  if (is_current(*provenance)) return std::nullopt;
  return OutcomeOf(entry, inputs, *std::move(provenance), limit);
}

/// Refits a batch with several threads, which take runs from the store and write their outcomes to it.
class Refitter {
 public:
  Refitter(const Source& source, Store& store, const RefitOptions& options, RefitCounts& counts)
      : source_(source), store_(store), options_(options), counts_(counts), limit_(options.fit_time) {}

  /// The loop of each thread.
  void Work() {
    try {
      while (std::optional<StoredRun> run = NextRun()) {
        const Attempt attempt = TryOne(*run);
        const auto& outcome = attempt.outcome;
        const bool is_cut_off = outcome && IsStopped() && outcome->exit_code == ExitCode(StatusCode::kTryAgain);
        if (is_cut_off) return;
        Record(*run, attempt);
      }
    } catch (const std::exception& error) {  // out of memory between two runs
      const std::scoped_lock lock(mutex_);
      error_ = {StatusCode::kInternal, std::string("internal error: ") + error.what()};
    }
  }

  /// Relays the stop of the options to the fits in progress until `done`. A signal handler may only set a flag.
  void RelayStop(const std::stop_token& done) {
    constexpr std::chrono::milliseconds kPoll{50};
    std::mutex mutex;
    std::condition_variable_any changed;
    std::unique_lock lock(mutex);
    while (!done.stop_requested() && !IsStopped()) changed.wait_for(lock, done, kPoll, [] { return false; });
    if (IsStopped()) limit_.StopAll();
  }

  /// The error that ended the refit, if any.
  const std::optional<Status>& error() const { return error_; }

 private:
  static constexpr int kPage = 256;
  static constexpr std::chrono::seconds kCommitInterval{1};

  struct Attempt {
    std::optional<RunOutcome> outcome;  ///< std::nullopt: the rows of the run need no other.
    bool is_result_current = false;     ///< The inputs are those of the stored rows.
  };

  /// Fits a run unless its rows need no other. An exception, from a bug or lack of memory, fails only this run. The
  /// next refit tries it again.
  Attempt TryOne(const StoredRun& run) {
    Attempt attempt;
    try {
      const auto is_current = [&](const Provenance& provenance) {
        attempt.is_result_current = run.provenance.Agrees(provenance);
        return IsCurrent(run, provenance);
      };
      attempt.outcome = RefitUnless(source_, run.entry, options_, is_current, &limit_);
    } catch (const std::exception& error) {
      attempt.outcome =
          Failure(run.entry, options_, {StatusCode::kInternal, std::string("internal error: ") + error.what()});
    }
    return attempt;
  }

  bool IsStopped() const { return options_.stop != nullptr && options_.stop->load(); }

  /// Whether the rows of a run need no attempt with these inputs.
  bool IsCurrent(const StoredRun& run, const Provenance& provenance) const {
    if (!run.exit_code || options_.force || *run.exit_code == ExitCode(StatusCode::kInternal) ||
        (options_.retry_failed && *run.exit_code > 1))
      return false;
    const Provenance given_up = GivenUp(provenance, options_.fit_time);
    const bool is_given_up = *run.exit_code == ExitCode(StatusCode::kTryAgain);
    if (run.provenance.Agrees(is_given_up ? given_up : provenance)) return true;
    if (run.attempt.empty() || options_.retry_failed || options_.replace_by_failures) return false;
    return run.attempt == AttemptOf(provenance) || run.attempt == AttemptOf(given_up);
  }

  std::optional<StoredRun> NextRun() {
    const std::scoped_lock lock(mutex_);
    if (error_ || IsStopped()) return std::nullopt;
    if (page_.empty() && !at_end_) {
      auto next = store_.Next(position_, kPage);
      if (!next) {
        error_ = next.error();
        return std::nullopt;
      }
      page_.assign(std::make_move_iterator(next->begin()), std::make_move_iterator(next->end()));
      at_end_ = page_.empty();
    }
    if (page_.empty()) return std::nullopt;
    StoredRun run = std::move(page_.front());
    page_.pop_front();
    position_ = run.entry.position + 1;
    return run;
  }

  /// Stores the outcome of an attempt, if there is one and it may replace the rows of the run. Returns whether the rows
  /// are of a former state.
  Result<bool> Keep(const StoredRun& run, const Attempt& attempt) {
    const std::string& id = run.entry.id;
    if (!attempt.outcome) {
      if (run.stale.empty() || !attempt.is_result_current) return !run.stale.empty();
      auto marked = store_.MarkCurrent(id);
      counts_.restored += marked ? 1 : 0;
      return marked ? Result<bool>(false) : tl::unexpected(std::move(marked).error());
    }
    const auto is_gone = [&](const std::string& path) {
      const auto bytes = source_.read(path);
      return !bytes && bytes.error().code == StatusCode::kNotFound;
    };
    ASSIGN_OR_RETURN(auto renamed, store_.TakeOver(id, attempt.outcome->provenance.data_sha256, is_gone));
    counts_.renamed += renamed ? 1 : 0;
    if (options_.replace_by_failures) {
      auto put = store_.Put(id, *attempt.outcome);
      return put ? Result<bool>(false) : tl::unexpected(std::move(put).error());
    }
    const bool is_bug = attempt.outcome->exit_code == ExitCode(StatusCode::kInternal);  // tried again next time
    auto why =
        store_.PutUnlessWorse(id, *attempt.outcome, is_bug ? "" : AttemptOf(attempt.outcome->provenance), is_gone);
    return why ? Result<bool>(!why->empty()) : tl::unexpected(std::move(why).error());
  }

  /// Counts a run, and stores the outcome of its attempt.
  void Record(const StoredRun& run, const Attempt& attempt) {
    const std::scoped_lock lock(mutex_);
    if (error_) return;
    const Result<bool> is_stale = Keep(run, attempt);
    Result<void> stored = is_stale ? Result<void>() : tl::unexpected(is_stale.error());
    const auto now = std::chrono::steady_clock::now();
    if (stored && now - last_commit_ >= kCommitInterval) {
      stored = Commit();
      last_commit_ = std::chrono::steady_clock::now();
    }
    if (!stored) {
      error_ = stored.error();
      return;
    }
    (attempt.outcome ? counts_.refitted : counts_.current) += 1;
    const int exit_code = attempt.outcome ? attempt.outcome->exit_code : run.exit_code.value_or(0);
    if (*is_stale) {
      counts_.stale += 1;
      counts_.stale_before += attempt.outcome ? 0 : 1;
    } else if (exit_code > 1) {
      counts_.unfitted += 1;
    }
    if (options_.progress) options_.progress(counts_);
  }

  Result<void> Commit() {
    auto committed = store_.Commit();
    if (committed && options_.committed) committed = options_.committed();
    return committed;
  }

  const Source& source_;
  Store& store_;
  const RefitOptions& options_;
  RefitCounts& counts_;
  TimeLimit limit_;
  std::mutex mutex_;  // for all members below, the store and the counts
  std::deque<StoredRun> page_;
  std::int64_t position_ = 0;
  bool at_end_ = false;
  std::chrono::steady_clock::time_point last_commit_ = std::chrono::steady_clock::now();
  std::optional<Status> error_;
};

/// What is asked of all fits of a batch.
Result<std::string> BatchJson(const RefitOptions& options) {
  auto json = nlohmann::ordered_json::parse(OptionsJson(options.run));
  for (const auto& [key, file] :
       {std::pair{"rig_sha256", &options.rig}, {"calibration_sha256", &options.calibration}}) {
    if (!*file) continue;
    ASSIGN_OR_RETURN(auto hash, Sha256(**file));
    json[key] = std::move(hash);
  }
  return JsonText(json);
}

}  // namespace

RunOutcome RefitRun(const Source& source, const ManifestEntry& entry, const RefitOptions& options) {
  return *RefitUnless(source, entry, options, [](const Provenance&) { return false; });
}

Result<RefitCounts> Refit(const Source& source, Store& store, const RefitOptions& options) {
  store.ShortenWaitsOnStop(options.stop);
  ASSIGN_OR_RETURN(const auto batch, BatchJson(options));
  ASSIGN_OR_RETURN(const auto meta,
                   store.Begin(source, options.shard, batch, [&] { return CheckGroupBy(store, options.group_by); }));
  RETURN_IF_ERROR(store.KeepCommand(source.folder ? options.flags : "", source.folder.value_or("")));
  if (options.force) {
    RETURN_IF_ERROR(store.MarkBatch());
  }
  RefitCounts counts;
  counts.runs = options.shard ? options.shard->End(meta.runs) - options.shard->Begin(meta.runs) : meta.runs;
  Refitter refitter(source, store, options, counts);
  const int threads = ThreadsOrCores(options.threads);
  {
    const std::jthread relay([&](const std::stop_token& done) { refitter.RelayStop(done); });
    ParallelFor(threads, threads, [&](int) { refitter.Work(); });
  }
  if (refitter.error()) return tl::unexpected(*refitter.error());
  counts.stopped = counts.done() < counts.runs;
  if (!counts.stopped) {
    ASSIGN_OR_RETURN(const auto changed, store.MarkChangedFiles(source));
    counts.changed = changed;
  }
  RETURN_IF_ERROR(counts.stopped ? store.Commit() : store.Complete());
  return counts;
}

}  // namespace pendulum
