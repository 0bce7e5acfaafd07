// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/fit_store.h"
#include "service/fitter.h"
#include "service/service_metrics.h"

namespace pendulum {

/// Progress of a batch, with its runs in the order in which they were sent. For any thread.
class BatchProgress {
 public:
  struct Run {
    std::string id, name;
    std::optional<int> exit_code;  ///< std::nullopt: the run waits.
    std::string reason;
    bool is_removed = false;  ///< It was deleted before it was fitted.
  };

  explicit BatchProgress(std::vector<Run> runs);

  /// Progress of a stored batch.
  explicit BatchProgress(std::vector<ListedFit> fits);

  void MarkDone(const std::string& id, int exit_code, const std::string& reason);
  void MarkRemoved(const std::string& id);

  /// The run at a place, if it and all runs before it are done or deleted; otherwise std::nullopt.
  std::optional<Run> DoneAt(std::size_t place) const;

  /// Marks the batch as deleted: no more runs follow.
  void Delete();
  bool is_deleted() const;

  std::size_t places() const { return runs_.size(); }

  /// Number of runs without deleted ones.
  std::size_t runs() const;

 private:
  Run* Find(const std::string& id);

  mutable std::mutex mutex_;
  std::vector<Run> runs_;
  std::map<std::string, std::size_t, std::less<>> places_;  // places of the runs by id
  mutable std::size_t done_ = 0;                            // all runs before this place are done
  bool is_deleted_ = false;
};

/// Fits the waiting runs of batches, first come, first served, with a lower priority than requests for single fits. If
/// the store is not available, it retries. After any interruption the stored runs continue at the next start.
class BatchQueue {
 public:
  /// `say`: receives messages that no answer contains, from any thread; may be empty.
  BatchQueue(FitStore& store, Fitter& fitter, ServiceMetrics& metrics, std::function<void(const std::string&)> say);
  BatchQueue(const BatchQueue&) = delete;
  BatchQueue& operator=(const BatchQueue&) = delete;
  BatchQueue(BatchQueue&&) = delete;
  BatchQueue& operator=(BatchQueue&&) = delete;
  ~BatchQueue();

  /// Starts `threads` threads (0: one per core) and queues the waiting runs of the store. Call it once. Errors: of the
  /// store; kTryAgain: no thread can be started.
  Result<void> Begin(int threads);

  /// Reserves room for `runs` runs, unless more than `max_waiting` would then wait; Release returns it.
  bool Reserve(std::size_t runs, std::size_t max_waiting);
  void Release(std::size_t runs);

  /// Queues a stored batch, in the room reserved for it.
  void Add(const std::string& batch, const std::vector<FitOrder>& orders);

  /// Removes a batch: its waiting runs are not fitted, and fits in progress are stopped. It must have been deleted from
  /// the store.
  void Delete(const std::string& batch);

  /// As Delete, but the batch remains, with the runs that are done. The others must have been deleted from the store.
  void Cancel(const std::string& batch);

  /// Stops the fit of a run, if it is in progress. The run must have been deleted from the store.
  void StopFit(const std::string& id);

  /// Progress of a running batch; nullptr for other batches.
  std::shared_ptr<BatchProgress> ProgressOf(const std::string& batch) const;

  std::size_t waiting() const;

  /// Starts no more runs; unfinished runs are left for the next start of the service.
  void Stop();

 private:
  Result<void> StartThreads(int threads);
  void Work();
  std::optional<FitStore::Waiting> NextRun();
  Result<void> TryOne(const FitStore::Waiting& run);
  Result<void> FitOne(const FitStore::Waiting& run);
  Result<void> StoreOutcome(const FitStore::Waiting& run, const RunOutcome& outcome);
  void ReportReason(const FitStore::Waiting& run, const Status& why, std::chrono::seconds pause);
  void PutBack(const FitStore::Waiting& run, const Status& why, std::chrono::seconds pause);
  std::stop_token TokenOf(const FitStore::Waiting& run) const;
  void EndFit(const FitStore::Waiting& run);
  void StopFitsOf(const std::string& batch);
  template <typename Notify>
  void FinishRun(const FitStore::Waiting& run, const Notify& notify);

  FitStore& store_;
  Fitter& fitter_;
  ServiceMetrics& metrics_;
  std::function<void(const std::string&)> say_;
  mutable std::mutex mutex_;  // for the members below
  std::condition_variable changed_;
  std::deque<FitStore::Waiting> waiting_;
  struct Batch {
    std::shared_ptr<BatchProgress> progress;
    std::size_t left = 0;  // runs that are not done
  };
  std::map<std::string, Batch, std::less<>> batches_;
  struct Fit {
    std::string batch;
    std::stop_source stop;
  };
  std::map<std::string, Fit, std::less<>> in_progress_;  // by the id of the run
  std::size_t reserved_ = 0;                             // runs that are not in the store yet
  bool is_stopping_ = false;
  std::vector<std::jthread> threads_;  // last member, so they are joined before the others are destroyed
};

}  // namespace pendulum
