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
#include <string>
#include <thread>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/batch/fit_store.h"
#include "service/fitter.h"
#include "service/service_metrics.h"

namespace pendulum {

/// How far a batch is, run by run in the order they were sent. For any thread.
class BatchProgress {
 public:
  struct Run {
    std::string id, name;
    std::optional<int> exit_code;  ///< None: it waits.
    std::string reason;
    bool is_gone = false;  ///< It was deleted before its turn came.
  };

  explicit BatchProgress(std::vector<Run> runs);

  /// Of a batch as it is kept.
  explicit BatchProgress(std::vector<ListedFit> fits);

  void Done(const std::string& id, int exit_code, const std::string& reason);
  void Gone(const std::string& id);

  /// The run at a place, once it and all before it are done or gone; none before that.
  std::optional<Run> DoneAt(std::size_t place) const;

  /// There will be no more of it.
  void Delete();
  bool is_deleted() const;

  std::size_t places() const { return runs_.size(); }

  /// Those that are not gone.
  std::size_t runs() const;

 private:
  Run* Find(const std::string& id);

  mutable std::mutex mutex_;
  std::vector<Run> runs_;
  std::map<std::string, std::size_t, std::less<>> places_;  // of ids
  mutable std::size_t done_ = 0;                            // all runs before this place are done
  bool is_deleted_ = false;
};

/// Works off the runs of batches that wait in the store, first come, first served, beside requests that want their
/// answer at once and with less of the processor than these. A store that cannot be had is asked again and again.
/// Whatever ends it, what is in the store goes on next time.
class BatchQueue {
 public:
  /// `say`: whom to tell what no answer does, from any thread; may be empty.
  BatchQueue(FitStore& store, Fitter& fitter, ServiceMetrics& metrics, std::function<void(const std::string&)> say);
  BatchQueue(const BatchQueue&) = delete;
  BatchQueue& operator=(const BatchQueue&) = delete;
  BatchQueue(BatchQueue&&) = delete;
  BatchQueue& operator=(BatchQueue&&) = delete;
  ~BatchQueue();

  /// Takes up what waits in the store, once, with so many threads; 0: cores. Errors: of the store; kTryAgain: no thread
  /// can be had.
  Result<void> Begin(int threads);

  /// Keeps room for so many runs, unless more than `most` would wait then; and gives it back.
  bool Reserve(std::size_t runs, std::size_t most);
  void Release(std::size_t runs);

  /// Takes up a batch that has been stored, in the room that was kept for it.
  void Add(const std::string& batch, const std::vector<FitOrder>& orders);

  /// Passes over what waits of a batch.
  void Delete(const std::string& batch);

  /// Of a batch that is being worked on; null of any other.
  std::shared_ptr<BatchProgress> ProgressOf(const std::string& batch) const;

  std::size_t waiting() const;

  /// No more runs; those under way are left for the next time.
  void Stop();

 private:
  Result<void> StartThreads(int threads);
  void Work();
  std::optional<FitStore::Waiting> Take();
  Result<void> TryOne(const FitStore::Waiting& run);
  Result<void> FitOne(const FitStore::Waiting& run);
  Result<void> Keep(const FitStore::Waiting& run, const RunOutcome& outcome);
  void SayWhy(const FitStore::Waiting& run, const Status& why, std::chrono::seconds pause);
  void PutBack(const FitStore::Waiting& run, const Status& why, std::chrono::seconds pause);
  template <typename Tell>
  void Settle(const FitStore::Waiting& run, const Tell& tell);

  FitStore& store_;
  Fitter& fitter_;
  ServiceMetrics& metrics_;
  std::function<void(const std::string&)> say_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<FitStore::Waiting> waiting_;
  struct Batch {
    std::shared_ptr<BatchProgress> progress;
    std::size_t left = 0;  // runs that are not done
  };
  std::map<std::string, Batch, std::less<>> batches_;
  std::size_t reserved_ = 0;  // runs that are not in the store yet
  bool is_stopping_ = false;
  std::vector<std::jthread> threads_;  // last, so that they end before the rest goes
};

}  // namespace pendulum
