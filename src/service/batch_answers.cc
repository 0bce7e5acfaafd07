// SPDX-License-Identifier: Apache-2.0
#include "service/batch_answers.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/json.h"
#include "pendulum/base/rounding.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utc_time.h"
#include "pendulum/service/fit_request.h"
#include "service/answers.h"
#include "service/repeated_request.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

HttpResponse BatchAnswer(ServiceState& state, const std::string& id, int status) {
  auto batch = state.store->FindBatch(id);
  if (!batch) return ProblemAnswer(batch.error());
  const auto runs = state.store->RunsOf(id);
  if (!runs) return ProblemAnswer(runs.error());
  batch->done = std::ranges::count_if(*runs, [](const ListedFit& fit) { return fit.exit_code.has_value(); });
  batch->failed = std::ranges::count_if(*runs, [](const ListedFit& fit) { return !fit.reason.empty(); });
  Json fits = Json::array();
  for (const ListedFit& fit : *runs) {
    Json item = ItemOf(fit);
    for (const char* key : {"file", "created", "batch", "window_s", "recommended", "models"}) item.erase(key);
    fits.push_back(std::move(item));
  }
  Json json = ItemOf(*batch);
  json["fits"] = std::move(fits);
  return JsonAnswer(json, status);
}

std::vector<FitOrder> OrdersOf(FitRequest request) {
  const std::string created = UtcTimeText(), flags = JsonText(JsonOf(request.flags));
  std::vector<FitOrder> orders;
  orders.reserve(request.data.size());
  for (NamedBytes& data : request.data) {
    orders.push_back({MakeId(), created, flags, {std::move(data), request.rig, request.calibration}});
  }
  return orders;
}

/// Events of a batch from run `place` on: first the runs that are done, later those that become done.
class BatchEvents {
 public:
  BatchEvents(std::shared_ptr<const BatchProgress> progress, std::size_t place) : progress_(std::move(progress)) {
    while (place_ < place && Advance()) {
    }
  }

  EventText Next() {
    constexpr int kMaxAtOnce = 500;
    EventText events;
    if (progress_->is_deleted()) return {"", true};
    for (int i = 0; i < kMaxAtOnce && place_ < progress_->places(); ++i) {
      const auto run = Advance();
      if (!run) return events;
      if (!run->is_removed) events.text += FitEvent(*run);
    }
    if (place_ < progress_->places()) return events;
    events.text += "event: done\ndata: " + JsonText({{"runs", done_}, {"done", done_}, {"failed", failed_}}) + "\n\n";
    events.is_last = true;
    return events;
  }

 private:
  /// The next run, if it is done.
  std::optional<BatchProgress::Run> Advance() {
    auto run = progress_->DoneAt(place_);
    if (!run) return run;
    ++place_;
    if (run->is_removed) return run;
    ++done_;
    if (!run->reason.empty()) ++failed_;
    return run;
  }

  std::string FitEvent(const BatchProgress::Run& run) const {
    const Json data = {{"id", run.id},  {"name", run.name},  {"exit_code", *run.exit_code}, {"reason", run.reason},
                       {"done", done_}, {"failed", failed_}, {"runs", progress_->runs()}};
    return "id: " + std::to_string(place_) + "\nevent: fit\ndata: " + JsonText(data) + "\n\n";
  }

  std::shared_ptr<const BatchProgress> progress_;
  std::size_t place_ = 0, done_ = 0, failed_ = 0;
};

/// Progress of a batch that is no longer running.
Result<std::shared_ptr<const BatchProgress>> ProgressFromStore(ServiceState& state, const std::string& id) {
  RETURN_IF_ERROR(state.store->FindBatch(id));
  ASSIGN_OR_RETURN(auto fits, state.store->RunsOf(id));
  return std::make_shared<const BatchProgress>(std::move(fits));
}

/// Number of the last event that a reconnecting client received (WHATWG HTML, 9.2.4); 0 if it sends none.
std::size_t LastEvent(const HttpRequest& http) {
  std::size_t last = 0;
  const std::string_view text = http.Field("Last-Event-ID").value_or("");
  std::from_chars(text.data(), text.data() + text.size(), last);
  return last;
}

}  // namespace

HttpResponse PostBatch(ServiceState& state, const Call& call) {
  return AnswerOnce(state, call, [&](const std::optional<RequestKey>& key) {
    auto request = ParseBatchRequest(call.http, call.target, state.options.limits);
    if (!request) return ProblemResponse(request.error());
    const std::size_t runs = request->data.size();
    if (!state.queue.Reserve(runs, state.options.limits.max_runs)) {
      return ProblemResponse(
          RetryLater(ProblemKind::kTooManyRequests, std::to_string(state.queue.waiting()) +
                                                        " recordings of batches wait already, but this service keeps " +
                                                        std::to_string(state.options.limits.max_runs) + " at most"));
    }
    const std::vector<FitOrder> orders = OrdersOf(*std::move(request));
    const std::string id = MakeId();
    if (const auto kept = state.store->AddBatch(id, orders.front().created, orders, key); !kept) {
      state.queue.Release(runs);
      return ProblemAnswer(kept.error());
    }
    state.queue.Add(id, orders);
    HttpResponse response = BatchAnswer(state, id, 202);
    response.fields.push_back({"Location", "/v1/batches/" + id});
    return response;
  });
}

HttpResponse ListBatches(ServiceState& state, const Call& call) {
  if (auto checked = CheckQuery(call.target, {"limit", "before"}); !checked) return ProblemAnswer(checked.error());
  const auto page = PageOf(call.target);
  if (!page) return ProblemAnswer(page.error());
  const auto batches = state.store->ListBatches(page->limit, page->before);
  if (!batches) return ProblemAnswer(batches.error());
  return PageAnswer("batches", *batches, &ListedBatch::batch, page->limit);
}

HttpResponse GetBatch(ServiceState& state, const Call& call) { return BatchAnswer(state, call.id, 200); }

HttpResponse GetBatchAgreement(ServiceState& state, const Call& call) {
  const auto agreement = state.store->AgreementOf(call.id);
  if (!agreement) return ProblemAnswer(agreement.error());
  Json means = Json::array(), outliers = Json::array();
  for (const RunsMean& mean : agreement->means) {
    means.push_back({{"name", mean.parameter},
                     {"unit", mean.unit},
                     {"mean", mean.mean},
                     {"total_std_error", mean.total_std_error},
                     {"text", PlusMinusText(mean.mean, mean.total_std_error)},
                     {"recordings", mean.runs}});
  }
  for (const DisagreeingRun& run : agreement->outliers)
    outliers.push_back({{"id", run.id}, {"parameter", run.parameter}});
  return JsonAnswer({{"law", agreement->law.empty() ? Json(nullptr) : Json(agreement->law)},
                     {"level", agreement->level},
                     {"text", agreement->text},
                     {"means", std::move(means)},
                     {"outliers", std::move(outliers)}},
                    200);
}

HttpResponse GetBatchEvents(ServiceState& state, const Call& call) {
  std::shared_ptr<const BatchProgress> progress = state.queue.ProgressOf(call.id);
  if (!progress) {
    auto done = ProgressFromStore(state, call.id);
    if (!done) return ProblemAnswer(done.error());
    progress = *std::move(done);
  }
  const std::size_t last = std::min(LastEvent(call.http), progress->places());
  HttpResponse response;
  response.events = [events = std::make_shared<BatchEvents>(std::move(progress), last)] { return events->Next(); };
  return response;
}

HttpResponse DeleteBatch(ServiceState& state, const Call& call) {
  if (auto checked = CheckQuery(call.target, {"keep"}); !checked) return ProblemAnswer(checked.error());
  const std::string keep = QueryValue(call.target, "keep");
  if (!keep.empty() && keep != "done") {
    return ProblemAnswer({StatusCode::kInvalidArgument, "keep is '" + keep + "'; it must be done"});
  }
  const auto deleted = keep.empty() ? state.store->DeleteBatch(call.id) : state.store->DeleteWaiting(call.id);
  if (!deleted) return ProblemAnswer(deleted.error());
  if (keep.empty()) {
    state.queue.Delete(call.id);
  } else {
    state.queue.Cancel(call.id);
  }
  return {204, {}, "", {}};
}

}  // namespace pendulum
