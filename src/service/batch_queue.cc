// SPDX-License-Identifier: Apache-2.0
#include "service/batch_queue.h"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

#include "pendulum/base/parallel.h"
#include "pendulum/base/try.h"
#include "pendulum/service/fit_request.h"

namespace pendulum {
namespace {

/// Lowers the priority of the calling thread only, as setpriority does on Linux.
void LowerThreadPriority() {
  constexpr int kNiceness = 5;
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNiceness);
}

std::vector<BatchProgress::Run> RunsOf(std::vector<ListedFit> fits) {
  std::vector<BatchProgress::Run> runs;
  runs.reserve(fits.size());
  for (ListedFit& fit : fits) {
    runs.push_back({std::move(fit.id), fit.ShownName(), fit.exit_code, std::move(fit.reason), false});
  }
  return runs;
}

}  // namespace

BatchProgress::BatchProgress(std::vector<ListedFit> fits) : BatchProgress(RunsOf(std::move(fits))) {}

BatchProgress::BatchProgress(std::vector<Run> runs) : runs_(std::move(runs)) {
  for (std::size_t place = 0; place < runs_.size(); ++place) places_.emplace(runs_[place].id, place);
}

BatchProgress::Run* BatchProgress::Find(const std::string& id) {
  const auto found = places_.find(id);
  return found == places_.end() ? nullptr : &runs_[found->second];
}

void BatchProgress::MarkDone(const std::string& id, int exit_code, const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  Run* run = Find(id);
  if (run == nullptr) return;
  run->exit_code = exit_code;
  run->reason = reason;
}

void BatchProgress::MarkRemoved(const std::string& id) {
  const std::scoped_lock lock(mutex_);
  if (Run* run = Find(id); run != nullptr) run->is_removed = true;
}

std::size_t BatchProgress::runs() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<std::size_t>(std::ranges::count(runs_, false, &Run::is_removed));
}

std::optional<BatchProgress::Run> BatchProgress::DoneAt(std::size_t place) const {
  const std::scoped_lock lock(mutex_);
  while (done_ < runs_.size() && (runs_[done_].exit_code || runs_[done_].is_removed)) ++done_;
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

BatchQueue::BatchQueue(FitStore& store, Fitter& fitter, ServiceMetrics& metrics,
                       std::function<void(const std::string&)> say)
    : store_(store), fitter_(fitter), metrics_(metrics), say_(std::move(say)) {}

BatchQueue::~BatchQueue() {
  Stop();
  fitter_.StopAll();
}

Result<void> BatchQueue::Begin(int threads) {
  ASSIGN_OR_RETURN(auto waiting, store_.WaitingRuns());
  std::map<std::string, std::size_t, std::less<>> left;
  for (const FitStore::Waiting& run : waiting) ++left[run.batch];
  const std::scoped_lock lock(mutex_);
  for (const auto& [batch, runs] : left) {
    ASSIGN_OR_RETURN(auto kept, store_.RunsOf(batch));
    batches_.emplace(batch, Batch{std::make_shared<BatchProgress>(std::move(kept)), runs});
  }
  waiting_.insert(waiting_.end(), waiting.begin(), waiting.end());
  return StartThreads(threads);
}

Result<void> BatchQueue::StartThreads(int threads) {
  try {
    for (int i = 0; i < ThreadsOrCores(threads); ++i) threads_.emplace_back([this] { Work(); });
  } catch (const std::system_error& error) {
    if (threads_.empty()) {
      return Error(StatusCode::kTryAgain, std::string("cannot start a thread, ") + error.what() +
                                              "; end other processes, or raise the limit on threads");
    }
  }
  return {};
}

bool BatchQueue::Reserve(std::size_t runs, std::size_t max_waiting) {
  const std::scoped_lock lock(mutex_);
  if (waiting_.size() + reserved_ + runs > max_waiting) return false;
  reserved_ += runs;
  return true;
}

void BatchQueue::Release(std::size_t runs) {
  const std::scoped_lock lock(mutex_);
  reserved_ -= runs;
}

void BatchQueue::Add(const std::string& batch, const std::vector<FitOrder>& orders) {
  std::vector<BatchProgress::Run> runs;
  runs.reserve(orders.size());
  for (const FitOrder& order : orders) runs.push_back({order.id, order.files.data.name, std::nullopt, "", false});
  const std::scoped_lock lock(mutex_);
  batches_.emplace(batch, Batch{std::make_shared<BatchProgress>(std::move(runs)), orders.size()});
  for (const FitOrder& order : orders) waiting_.push_back({order.id, batch});
  reserved_ -= orders.size();
  changed_.notify_all();
}

void BatchQueue::Delete(const std::string& batch) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(waiting_, [&](const FitStore::Waiting& run) { return run.batch == batch; });
  StopFitsOf(batch);
  const auto found = batches_.find(batch);
  if (found == batches_.end()) return;
  found->second.progress->Delete();
  batches_.erase(found);
}

void BatchQueue::Cancel(const std::string& batch) {
  const std::scoped_lock lock(mutex_);
  StopFitsOf(batch);
  const auto found = batches_.find(batch);
  if (found == batches_.end()) return;
  for (const FitStore::Waiting& run : waiting_) {
    if (run.batch != batch) continue;
    found->second.progress->MarkRemoved(run.id);
    --found->second.left;
  }
  std::erase_if(waiting_, [&](const FitStore::Waiting& run) { return run.batch == batch; });
  if (found->second.left == 0) batches_.erase(found);
}

void BatchQueue::StopFit(const std::string& id) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = in_progress_.find(id); found != in_progress_.end()) found->second.stop.request_stop();
}

/// Call it with the mutex held.
void BatchQueue::StopFitsOf(const std::string& batch) {
  for (auto& [id, fit] : in_progress_) {
    if (fit.batch == batch) fit.stop.request_stop();
  }
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
  LowerThreadPriority();
  constexpr std::chrono::seconds kShortest{1}, kLongest{60};
  std::chrono::seconds pause = kShortest;
  while (const auto run = NextRun()) {
    const auto settled = TryOne(*run);
    EndFit(*run);
    if (!settled) PutBack(*run, settled.error(), pause);
    pause = settled ? kShortest : std::min(2 * pause, kLongest);
  }
}

std::optional<FitStore::Waiting> BatchQueue::NextRun() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return is_stopping_ || !waiting_.empty(); });
  if (is_stopping_) return std::nullopt;
  FitStore::Waiting run = std::move(waiting_.front());
  waiting_.pop_front();
  in_progress_.emplace(run.id, Fit{run.batch, {}});
  return run;
}

std::stop_token BatchQueue::TokenOf(const FitStore::Waiting& run) const {
  const std::scoped_lock lock(mutex_);
  return in_progress_.at(run.id).stop.get_token();
}

void BatchQueue::EndFit(const FitStore::Waiting& run) {
  const std::scoped_lock lock(mutex_);
  in_progress_.erase(run.id);
}

/// Returns the error of a store that is not available now. An exception is a bug or lack of memory and fails only this
/// run.
Result<void> BatchQueue::TryOne(const FitStore::Waiting& run) {
  try {
    return FitOne(run);
  } catch (const std::exception& error) {
    try {
      RunOutcome outcome;
      outcome.exit_code = ExitCode(StatusCode::kInternal);
      outcome.reason.sentence = std::string("internal error: ") + error.what();
      return StoreOutcome(run, outcome);
    } catch (const std::exception&) {
      return Error(StatusCode::kInternal, "out of memory");  // short enough to need no allocation
    }
  }
}

/// The run is settled if it was stored, deleted meanwhile, or left for the next start.
Result<void> BatchQueue::FitOne(const FitStore::Waiting& run) {
  const std::stop_token unwanted = TokenOf(run);
  auto kept = store_.Find(run.id);
  if (!kept) {
    if (kept.error().code != StatusCode::kNotFound) return tl::unexpected(kept.error());
    FinishRun(run, [&](BatchProgress& progress) { progress.MarkRemoved(run.id); });
    return {};
  }
  FinishedRun fitted;
  const auto begin = std::chrono::steady_clock::now();
  if (const auto options = OptionsOf(kept->order); options) {
    fitted = fitter_.Fit(*options, std::move(kept->order.files), unwanted);
  } else {
    fitted.outcome.exit_code = ExitCode(options.error().code);
    fitted.outcome.reason = ReasonOf(options.error());
  }
  {
    const std::scoped_lock lock(mutex_);
    if (is_stopping_ && fitted.is_stopped) return {};
  }
  metrics_.CountFit("batch", fitted.outcome.exit_code, std::chrono::steady_clock::now() - begin);
  return StoreOutcome(run, fitted.outcome);
}

Result<void> BatchQueue::StoreOutcome(const FitStore::Waiting& run, const RunOutcome& outcome) {
  auto stored = store_.Put(run.id, outcome);
  const bool is_removed = !stored && stored.error().code == StatusCode::kNotFound;
  if (!stored && !is_removed) return stored;
  FinishRun(run, [&](BatchProgress& progress) {
    if (is_removed) {
      progress.MarkRemoved(run.id);
    } else {
      progress.MarkDone(run.id, outcome.exit_code, outcome.reason.text());
    }
  });
  return {};
}

void BatchQueue::ReportReason(const FitStore::Waiting& run, const Status& why, std::chrono::seconds pause) {
  try {
    metrics_.CountRetry();
    if (!say_) return;
    say_("run " + run.id + " of batch " + run.batch + " waits: " + why.message() + "; it is tried again within " +
         std::to_string(pause.count()) + " s");
  } catch (const std::exception&) {
    return;  // a message needs memory; the run continues without it
  }
}

/// Puts the run back at the front of the queue and pauses this thread.
void BatchQueue::PutBack(const FitStore::Waiting& run, const Status& why, std::chrono::seconds pause) {
  std::unique_lock lock(mutex_);
  if (!batches_.contains(run.batch)) return;
  ReportReason(run, why, pause);
  waiting_.push_front(run);
  changed_.wait_for(lock, pause, [&] { return is_stopping_; });
}

template <typename Notify>
void BatchQueue::FinishRun(const FitStore::Waiting& run, const Notify& notify) {
  const std::scoped_lock lock(mutex_);
  const auto found = batches_.find(run.batch);
  if (found == batches_.end()) return;
  notify(*found->second.progress);
  if (--found->second.left == 0) batches_.erase(found);
}

}  // namespace pendulum
