// SPDX-License-Identifier: Apache-2.0
#include "service/fit_answers.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <regex>
#include <string>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/sha256.h"
#include "pendulum/base/try.h"
#include "pendulum/base/utc_time.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/calibration/calibration_source.h"
#include "pendulum/report/estimate_texts.h"
#include "pendulum/report/json_parts.h"
#include "pendulum/report/markdown.h"
#include "pendulum/report/sections_json.h"
#include "pendulum/report/series.h"
#include "pendulum/service/fit_request.h"
#include "pendulum/web/report_page.h"
#include "service/answers.h"
#include "service/readings_request.h"
#include "service/repeated_request.h"
#include "service/samples_json.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

HttpResponse WithLocation(HttpResponse response, const std::string& id) {
  response.fields.push_back({"Location", "/v1/fits/" + id});
  return response;
}

/// The answer for a run that could not be fitted. Only its message and exit code were stored, so the status follows
/// from the exit code.
HttpResponse UnfittedAnswer(const ListedFit& fit) {
  const int exit_code = fit.exit_code.value_or(0);
  for (const StatusCode code : {StatusCode::kInvalidArgument, StatusCode::kDataLoss, StatusCode::kFailedPrecondition,
                                StatusCode::kTryAgain, StatusCode::kInternal}) {
    if (ExitCode(code) != exit_code) continue;
    const bool is_slow = code == StatusCode::kTryAgain;
    return is_slow ? ProblemResponse(RetryLater(ProblemKind::kTimedOut, fit.reason))
                   : ProblemAnswer({code, fit.reason});
  }
  return ProblemAnswer({StatusCode::kInternal, fit.reason});
}

/// A stored run with its result; otherwise the answer that says why there is none, or none yet.
tl::expected<KeptFit, HttpResponse> FindResult(ServiceState& state, const std::string& id) {
  auto kept = state.store->Find(id);
  if (!kept) return tl::unexpected(ProblemAnswer(kept.error()));
  if (!kept->fit.exit_code) {
    return tl::unexpected(ProblemResponse(
        RetryLater(ProblemKind::kConflict, "the fit " + kept->fit.id + " waits for its turn in a batch")));
  }
  if (kept->result.is_null()) return tl::unexpected(UnfittedAnswer(kept->fit));
  return *std::move(kept);
}

HttpResponse StoppingAnswer() {
  return ProblemResponse(RetryLater(ProblemKind::kStopping, "the service is being stopped"));
}

HttpResponse StoppedAnswer(const ServiceState& state, const Status& status) {
  if (state.is_stopping) return StoppingAnswer();
  return ProblemResponse(RetryLater(ProblemKind::kTimedOut, status.message()));
}

/// Fits the request and stores the fit.
HttpResponse FitAndStore(ServiceState& state, const Call& call, FitRequest request,
                         const std::optional<RequestKey>& key) {
  const auto begin = std::chrono::steady_clock::now();
  FitOrder order{MakeId(),
                 UtcTimeText(),
                 JsonText(JsonOf(request.flags)),
                 {std::move(request.data.front()), std::move(request.rig), std::move(request.calibration)},
                 std::move(request.name)};
  FinishedRun fitted = state.fitter.Fit(request.options, order.files, call.http.client_gone);
  state.metrics.CountFit("request", fitted.outcome.exit_code, std::chrono::steady_clock::now() - begin);
  if (fitted.is_stopped) return StoppedAnswer(state, *fitted.error);
  if (fitted.error) return ProblemAnswer(*fitted.error);
  if (const auto kept = state.store->Add(order, fitted.outcome, key); !kept) return ProblemAnswer(kept.error());
  state.fitter.Remember(order.id, fitted.run);
  return WithLocation(JsonAnswer(fitted.outcome.result), order.id);
}

/// Passes the fit of a stored run and its name to a function. The fit is repeated unless it is remembered.
template <typename Make>
HttpResponse WithFit(ServiceState& state, const Call& call, const Make& make) {
  auto kept = FindResult(state, call.id);
  if (!kept) return std::move(kept).error();
  const auto options = OptionsOf(kept->order);
  if (!options) return ProblemAnswer(options.error());
  const auto run = state.fitter.FitOf(call.id, *options, std::move(kept->order.files), call.http.client_gone);
  if (run) return make(**run, kept->fit.ShownName());
  return run.error().code == StatusCode::kTryAgain ? StoppedAnswer(state, run.error()) : ProblemAnswer(run.error());
}

/// The answer for a fit that is not remembered: there is none, it has too many samples to be remembered, or it must be
/// made again by another request.
HttpResponse NotRemembered(ServiceState& state, const std::string& id) {
  auto kept = FindResult(state, id);
  if (!kept) return std::move(kept).error();
  const std::int64_t limit = state.fitter.max_remembered();
  const auto samples = kept->result.at("recordings").at(0).at("used_samples").get<std::int64_t>();
  if (samples > limit) {
    return ProblemResponse({ProblemKind::kTooManySamples,
                            "this fit used " + std::to_string(samples) +
                                " samples; readings for other values are given for at most " + std::to_string(limit) +
                                ", so fit a shorter window (from, to)",
                            {}});
  }
  return ProblemResponse({ProblemKind::kConflict,
                          "the service does not hold this fit in memory; ask for /v1/fits/" + id +
                              "/series, which fits again, and then repeat this request",
                          {}});
}

/// The answer for readings that were stopped. The same values would take as long again, so the client must not repeat
/// the request.
HttpResponse StoppedReadings(const ServiceState& state) {
  if (state.is_stopping) return StoppingAnswer();
  const std::chrono::duration<double> limit = state.readings_limit.limit();
  return ProblemAnswer({StatusCode::kInvalidArgument, "with these values the motion was not computed after " +
                                                          NumberText(limit.count()) +
                                                          " s, the time limit; choose values nearer to the estimates"});
}

/// The identification with the name of its recording as path.
Identification NamedIdentification(const Identification& run, const std::string& name) {
  Identification named = run;
  named.recordings.front().data.path = name;
  return named;
}

Json FileJson(const SharedFile& file) {
  if (!file) return nullptr;
  auto json = ParseJsonObject(file->bytes, file->name, "file", "{}");
  return json ? *std::move(json) : Json(nullptr);
}

/// A calibration as JSON, also if a table was sent.
Json CalibrationJson(const SharedFile& file) {
  if (!file) return nullptr;
  const auto calibration = CalibrationFromText(file->bytes, file->name);
  return calibration ? calibration->source : Json(nullptr);
}

/// A query parameter that must be one of `words`; empty if it is missing.
Result<std::string> OneOf(const RequestTarget& target, std::string_view name,
                          const std::vector<std::string_view>& words) {
  std::string value = QueryValue(target, name);
  if (value.empty() || std::ranges::find(words, value) != words.end()) return value;
  return Error(StatusCode::kInvalidArgument,
               std::string(name) + " is '" + value + "'; it must be one of " + NameList(words));
}

/// "2026-11-23T21:40:05Z"; an offset from UTC, fractions of a second, or a day alone are allowed (RFC 3339).
Result<std::string> SinceOf(const RequestTarget& target) {
  static const std::regex form(
      R"(\d{4}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])([T ]([01]\d|2[0-3]):[0-5]\d(:[0-5]\d(\.\d{1,9})?)?(Z|[+-]([01]\d|2[0-3]):[0-5]\d)?)?)");
  std::string value = QueryValue(target, "since");
  if (value.empty() || std::regex_match(value, form)) return value;
  return Error(StatusCode::kInvalidArgument,
               "since is '" + value + "'; it must be a time such as 2026-11-23T21:40:05Z, or a day");
}

Result<FitFilter> FilterOf(const RequestTarget& target) {
  FitFilter filter;
  ASSIGN_OR_RETURN(const auto page, PageOf(target));
  std::vector<std::string_view> models;
  for (const MotionModel& model : MotionModels()) models.push_back(model.name);
  ASSIGN_OR_RETURN(auto model, OneOf(target, "model", models));
  ASSIGN_OR_RETURN(auto status, OneOf(target, "status", {"converged", "not_converged", "not_identifiable", "failed"}));
  ASSIGN_OR_RETURN(auto since, SinceOf(target));
  filter.limit = page.limit;
  filter.before = page.before;
  filter.model = std::move(model);
  filter.status = std::move(status);
  filter.since = std::move(since);
  filter.name = QueryValue(target, "name");
  filter.batch = QueryValue(target, "batch");
  return filter;
}

}  // namespace

HttpResponse PostFit(ServiceState& state, const Call& call) {
  return AnswerOnce(state, call, [&](const std::optional<RequestKey>& key) {
    auto request = ParseFitRequest(call.http, call.target, state.options.limits);
    if (!request) return ProblemResponse(request.error());
    return FitAndStore(state, call, *std::move(request), key);
  });
}

HttpResponse PostRefit(ServiceState& state, const Call& call) {
  return AnswerOnce(state, call, [&](const std::optional<RequestKey>& key) {
    auto kept = state.store->Find(call.id);
    if (!kept) return ProblemAnswer(kept.error());
    auto flags = FlagsOf(kept->order);
    if (!flags) return ProblemAnswer(flags.error());
    auto request = ParseRefitRequest(call.http, call.target, *std::move(flags), std::move(kept->order.files));
    if (!request) return ProblemResponse(request.error());
    if (request->name.empty()) request->name = kept->fit.name;
    return FitAndStore(state, call, *std::move(request), key);
  });
}

HttpResponse ListFits(ServiceState& state, const Call& call) {
  if (auto checked = CheckQuery(call.target, {"limit", "before", "model", "status", "name", "batch", "since"});
      !checked) {
    return ProblemAnswer(checked.error());
  }
  const auto filter = FilterOf(call.target);
  if (!filter) return ProblemAnswer(filter.error());
  const auto fits = state.store->List(*filter);
  if (!fits) return ProblemAnswer(fits.error());
  return PageAnswer("fits", *fits, &ListedFit::run, filter->limit);
}

HttpResponse GetFit(ServiceState& state, const Call& call) {
  auto kept = FindResult(state, call.id);
  if (!kept) return std::move(kept).error();
  AddTextsOfParameters(kept->result);  // results of earlier versions have none
  return JsonAnswer(kept->result);
}

HttpResponse RenameFit(ServiceState& state, const Call& call) {
  const auto name = ParseNameRequest(call.http);
  if (!name) return ProblemResponse(name.error());
  if (const auto renamed = state.store->Rename(call.id, *name); !renamed) return ProblemAnswer(renamed.error());
  const auto kept = state.store->Find(call.id);
  if (!kept) return ProblemAnswer(kept.error());
  return JsonAnswer({{"id", call.id}, {"name", kept->fit.ShownName()}, {"file", kept->fit.file}});
}

HttpResponse DeleteFit(ServiceState& state, const Call& call) {
  if (const auto deleted = state.store->DeleteFit(call.id); !deleted) return ProblemAnswer(deleted.error());
  state.queue.StopFit(call.id);
  return {204, {}, "", {}};
}

HttpResponse GetFitRequest(ServiceState& state, const Call& call) {
  const auto kept = state.store->Find(call.id);
  if (!kept) return ProblemAnswer(kept.error());
  const auto flags = FlagsOf(kept->order);
  if (!flags) return ProblemAnswer(flags.error());
  const auto sha256 = Sha256(kept->order.files.data.bytes);
  if (!sha256) return ProblemAnswer(sha256.error());
  return JsonAnswer({{"id", call.id},
                     {"name", kept->fit.ShownName()},
                     {"file", kept->fit.file},
                     {"created", kept->fit.created},
                     {"batch", kept->fit.batch ? Json(*kept->fit.batch) : Json(nullptr)},
                     {"options", JsonOf(*flags)},
                     {"rig", FileJson(kept->order.files.rig)},
                     {"calibration", CalibrationJson(kept->order.files.calibration)},
                     {"data_sha256", *sha256}});
}

HttpResponse GetRecording(ServiceState& state, const Call& call) {
  auto kept = state.store->Find(call.id);
  if (!kept) return ProblemAnswer(kept.error());
  return FileAnswer("text/csv; charset=utf-8", std::move(kept->order.files.data.bytes), kept->fit.file);
}

HttpResponse GetSamples(ServiceState& state, const Call& call) {
  const auto kept = state.store->Find(call.id);
  if (!kept) return ProblemAnswer(kept.error());
  auto options = OptionsOf(kept->order);
  if (!options) return ProblemAnswer(options.error());
  constexpr Eigen::Index kMaxShown = 4000;
  const auto read = ReadBytesOfRun(*options, kept->order.files);
  if (!read) return ProblemAnswer(read.error());
  return JsonAnswer(SamplesJson(read->recording, kMaxShown));
}

HttpResponse GetSeries(ServiceState& state, const Call& call) {
  return WithFit(state, call, [](const Identification& run, const std::string&) {
    return TextAnswer("application/json", ToSeriesJsonText(run));
  });
}

HttpResponse PostReadings(ServiceState& state, const Call& call) {
  const auto request = ParseReadingsRequest(call.http);
  if (!request) return ProblemResponse(request.error());
  const auto run = state.fitter.Find(call.id);
  if (!run) return NotRemembered(state, call.id);
  if (const auto exists = state.store->CheckFit(call.id); !exists) return ProblemAnswer(exists.error());
  const TimeLimit::Watch watch(state.readings_limit);
  const auto readings = ReadingsJson(*run, *request, watch.token());
  if (!readings && readings.error().code == StatusCode::kTryAgain) return StoppedReadings(state);
  if (!readings) return ProblemAnswer(readings.error());
  return TextAnswer("application/json", JsonText(*readings) + "\n");
}

HttpResponse GetSections(ServiceState& state, const Call& call) {
  return WithFit(state, call, [](const Identification& run, const std::string& name) {
    return TextAnswer("application/json", ToSectionsJsonText(NamedIdentification(run, name)));
  });
}

HttpResponse GetResiduals(ServiceState& state, const Call& call) {
  return WithFit(state, call, [](const Identification& run, const std::string& name) {
    if (run.fits.empty()) {
      return ProblemAnswer(
          {StatusCode::kNotFound, "this run has only closed forms and no fit, so there are no residuals"});
    }
    return FileAnswer("text/csv; charset=utf-8", ToResidualCsv(run, 0, run.MainFit()), "residuals of " + name);
  });
}

HttpResponse GetReport(ServiceState& state, const Call& call) {
  return WithFit(state, call, [](const Identification& run, const std::string& name) {
    return FileAnswer("text/html; charset=utf-8", ToHtml(NamedIdentification(run, name), ""), name + ".html");
  });
}

HttpResponse GetMarkdown(ServiceState& state, const Call& call) {
  return WithFit(state, call, [](const Identification& run, const std::string& name) {
    return FileAnswer("text/markdown; charset=utf-8", ToMarkdown(NamedIdentification(run, name)), name + ".md");
  });
}

}  // namespace pendulum
