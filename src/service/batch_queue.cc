// SPDX-License-Identifier: Apache-2.0
#include "service/batch_queue.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

#include "pendulum/base/parallel.h"
#include "pendulum/service/fit_request.h"

namespace pendulum {
namespace {

/// On Linux this is of the calling thread alone.
void BeNice() {
  constexpr int kNiceness = 10;
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNiceness);
}

}  // namespace

BatchProgress::BatchProgress(std::vector<Run> runs) : runs_(std::move(runs)) {
  for (std::size_t place = 0; place < runs_.size(); ++place) places_.emplace(runs_[place].id, place);
}

void BatchProgress::Done(const std::string& id, int exit_code, const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  const auto found = places_.find(id);
  if (found == places_.end()) return;
  Run& run = runs_[found->second];
  run.exit_code = exit_code;
  run.reason = reason;
}

std::optional<BatchProgress::Run> BatchProgress::DoneAt(std::size_t place) const {
  const std::scoped_lock lock(mutex_);
  while (done_ < runs_.size() && runs_[done_].exit_code) ++done_;
  return place < done_ ? std::optional(runs_[place]) : std::nullopt;
}

void BatchProgress::Delete() {
  const std::scoped_lock lock(mutex_);
  is_deleted_ = true;
}

bool BatchProgress::is_deleted() const {
  const std::scoped_lock lock(mutex_);
  return is_deleted_;
}

BatchQueue::BatchQueue(FitStore& store, Fitter& fitter, ServiceMetrics& metrics, int threads)
    : store_(store), fitter_(fitter), metrics_(metrics) {
  for (int i = 0; i < ThreadsOrCores(threads); ++i) threads_.emplace_back([this] { Work(); });
}

BatchQueue::~BatchQueue() {
  Stop();
  fitter_.StopAll();
}

Result<void> BatchQueue::Begin() {
  auto waiting = store_.WaitingRuns();
  if (!waiting) return tl::unexpected(waiting.error());
  std::map<std::string, std::size_t, std::less<>> left;
  for (const FitStore::Waiting& run : *waiting) ++left[run.batch];
  const std::scoped_lock lock(mutex_);
  for (const auto& [batch, runs] : left) {
    auto kept = store_.RunsOf(batch);
    if (!kept) return tl::unexpected(kept.error());
    std::vector<BatchProgress::Run> all;
    for (ListedFit& fit : *kept) {
      all.push_back({std::move(fit.id), std::move(fit.name), fit.exit_code, std::move(fit.reason)});
    }
    batches_.emplace(batch, Batch{std::make_shared<BatchProgress>(std::move(all)), runs});
  }
  waiting_.insert(waiting_.end(), waiting->begin(), waiting->end());
  changed_.notify_all();
  return {};
}

void BatchQueue::Add(const std::string& batch, const std::vector<FitOrder>& orders) {
  std::vector<BatchProgress::Run> runs;
  runs.reserve(orders.size());
  for (const FitOrder& order : orders) runs.push_back({order.id, order.files.data.name, std::nullopt, ""});
  const std::scoped_lock lock(mutex_);
  batches_.emplace(batch, Batch{std::make_shared<BatchProgress>(std::move(runs)), orders.size()});
  for (const FitOrder& order : orders) waiting_.push_back({order.id, batch});
  changed_.notify_all();
}

void BatchQueue::Delete(const std::string& batch) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(waiting_, [&](const FitStore::Waiting& run) { return run.batch == batch; });
  const auto found = batches_.find(batch);
  if (found == batches_.end()) return;
  found->second.progress->Delete();
  batches_.erase(found);
}

std::shared_ptr<BatchProgress> BatchQueue::ProgressOf(const std::string& batch) const {
  const std::scoped_lock lock(mutex_);
  const auto found = batches_.find(batch);
  return found == batches_.end() ? nullptr : found->second.progress;
}

std::size_t BatchQueue::waiting() const {
  const std::scoped_lock lock(mutex_);
  return waiting_.size();
}

void BatchQueue::Stop() {
  const std::scoped_lock lock(mutex_);
  is_stopping_ = true;
  changed_.notify_all();
}

void BatchQueue::Work() {
  BeNice();
  while (const auto run = Take()) FitOne(*run);
}

std::optional<FitStore::Waiting> BatchQueue::Take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return is_stopping_ || !waiting_.empty(); });
  if (is_stopping_) return std::nullopt;
  FitStore::Waiting run = std::move(waiting_.front());
  waiting_.pop_front();
  return run;
}

void BatchQueue::FitOne(const FitStore::Waiting& run) {
  auto kept = store_.Find(run.id);
  if (!kept) return Finish(run, ExitCode(kept.error().code), kept.error().message);  // deleted meanwhile, or a bad disk
  FittedRun fitted;
  const auto begin = std::chrono::steady_clock::now();
  if (const auto options = OptionsOf(kept->order); options) {
    fitted = fitter_.Fit(*options, std::move(kept->order.files));
  } else {
    fitted.outcome.exit_code = ExitCode(options.error().code);
    fitted.outcome.reason = options.error().message;
  }
  {
    const std::scoped_lock lock(mutex_);
    if (is_stopping_ && fitted.is_stopped) return;
  }
  const auto stored = store_.Put(run.id, fitted.outcome);
  metrics_.CountFit("batch", fitted.outcome.exit_code, std::chrono::steady_clock::now() - begin);
  Finish(run, stored ? fitted.outcome.exit_code : ExitCode(stored.error().code),
         stored ? fitted.outcome.reason : stored.error().message);
}

void BatchQueue::Finish(const FitStore::Waiting& run, int exit_code, const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  const auto found = batches_.find(run.batch);
  if (found == batches_.end()) return;
  found->second.progress->Done(run.id, exit_code, reason);
  if (--found->second.left == 0) batches_.erase(found);
}

}  // namespace pendulum
