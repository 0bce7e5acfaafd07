// SPDX-License-Identifier: Apache-2.0
#include "service/routes.h"

#include <optional>

#include "service/batch_answers.h"
#include "service/fit_answers.h"
#include "service/other_answers.h"
#include "service/preview_answers.h"

namespace pendulum {
namespace {

constexpr Audience kAll = Audience::kAnybody;
constexpr Audience kHolders = Audience::kTokenHolders;

constexpr std::array kRoutes = {
    Route{"POST", "/v1/fits", Lane::kFit, kHolders, QueryKind::kOwn, PostFit},
    Route{"GET", "/v1/fits", Lane::kQuick, kHolders, QueryKind::kOwn, ListFits},
    Route{"GET", "/v1/fits/{id}", Lane::kQuick, kHolders, QueryKind::kNone, GetFit},
    Route{"PATCH", "/v1/fits/{id}", Lane::kQuick, kHolders, QueryKind::kNone, RenameFit},
    Route{"DELETE", "/v1/fits/{id}", Lane::kQuick, kHolders, QueryKind::kNone, DeleteFit},
    Route{"GET", "/v1/fits/{id}/request", Lane::kQuick, kHolders, QueryKind::kNone, GetFitRequest},
    Route{"GET", "/v1/fits/{id}/recording", Lane::kQuick, kHolders, QueryKind::kNone, GetRecording},
    Route{"GET", "/v1/fits/{id}/samples", Lane::kFit, kHolders, QueryKind::kNone, GetSamples},
    Route{"GET", "/v1/fits/{id}/series", Lane::kFit, kHolders, QueryKind::kNone, GetSeries},
    Route{"POST", "/v1/fits/{id}/readings", Lane::kReadings, kHolders, QueryKind::kNone, PostReadings},
    Route{"GET", "/v1/fits/{id}/sections", Lane::kFit, kHolders, QueryKind::kNone, GetSections},
    Route{"GET", "/v1/fits/{id}/residuals", Lane::kFit, kHolders, QueryKind::kNone, GetResiduals},
    Route{"GET", "/v1/fits/{id}/report", Lane::kFit, kHolders, QueryKind::kNone, GetReport},
    Route{"GET", "/v1/fits/{id}/markdown", Lane::kFit, kHolders, QueryKind::kNone, GetMarkdown},
    Route{"POST", "/v1/fits/{id}/refits", Lane::kFit, kHolders, QueryKind::kOwn, PostRefit},
    Route{"POST", "/v1/previews", Lane::kFit, kHolders, QueryKind::kOwn, PostPreview},
    Route{"POST", "/v1/batches", Lane::kFit, kHolders, QueryKind::kOwn, PostBatch},
    Route{"GET", "/v1/batches", Lane::kQuick, kHolders, QueryKind::kOwn, ListBatches},
    Route{"GET", "/v1/batches/{id}", Lane::kQuick, kHolders, QueryKind::kNone, GetBatch},
    Route{"DELETE", "/v1/batches/{id}", Lane::kQuick, kHolders, QueryKind::kOwn, DeleteBatch},
    Route{"GET", "/v1/batches/{id}/agreement", Lane::kFit, kHolders, QueryKind::kNone, GetBatchAgreement},
    Route{"GET", "/v1/batches/{id}/events", Lane::kQuick, kHolders, QueryKind::kNone, GetBatchEvents},
    Route{"POST", "/v1/simulations", Lane::kFit, kHolders, QueryKind::kOwn, PostSimulation},
    Route{"POST", "/v1/calibrations", Lane::kFit, kHolders, QueryKind::kOwn, PostCalibration},
    Route{"GET", "/v1/models", Lane::kQuick, kHolders, QueryKind::kNone, GetModels},
    Route{"GET", "/v1/examples", Lane::kQuick, kHolders, QueryKind::kNone, ListExamples},
    Route{"GET", "/v1/examples/{id}", Lane::kQuick, kHolders, QueryKind::kNone, GetExample},
    Route{"GET", "/v1/live", Lane::kQuick, kHolders, QueryKind::kNone, GetLive},
    Route{"GET", "/v1/live/events", Lane::kQuick, kHolders, QueryKind::kNone, GetLiveEvents},
    Route{"GET", "/v1/live/recording", Lane::kQuick, kHolders, QueryKind::kNone, GetLiveRecording},
    Route{"GET", "/healthz", Lane::kQuick, kAll, QueryKind::kNone, GetHealth},
    Route{"GET", "/metrics", Lane::kQuick, kHolders, QueryKind::kNone, GetMetrics},
    Route{"GET", "/openapi.json", Lane::kQuick, kHolders, QueryKind::kNone, GetOpenApi},
    // The page itself interprets its paths and queries.
    Route{"GET", "/", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/fits", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/fits/{id}", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/batches/{id}", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/compare", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/calibration", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/live", Lane::kQuick, kAll, QueryKind::kOwn, GetPage},
    Route{"GET", "/app.js", Lane::kQuick, kAll, QueryKind::kNone, GetScript},
    Route{"GET", "/app.css", Lane::kQuick, kAll, QueryKind::kNone, GetStyle},
    Route{"GET", "/docs", Lane::kQuick, kAll, QueryKind::kNone, GetGuide},
    Route{"GET", "/docs/{path}", Lane::kQuick, kAll, QueryKind::kNone, GetGuideFile},
};

/// The text of the path in place of {id} (one segment) or of {path} at the end (any number of segments). It is empty if
/// the pattern has neither. Returns std::nullopt if the path does not match the pattern.
std::optional<std::string_view> MatchPath(std::string_view pattern, std::string_view path) {
  constexpr std::string_view kId = "{id}", kRest = "{path}";
  if (pattern.ends_with(kRest)) {
    const std::string_view folder = pattern.substr(0, pattern.size() - kRest.size());
    return path.starts_with(folder) ? std::optional(path.substr(folder.size())) : std::nullopt;
  }
  const std::size_t open = pattern.find(kId);
  if (open == std::string_view::npos) return path == pattern ? std::optional(std::string_view()) : std::nullopt;
  const std::string_view before = pattern.substr(0, open), after = pattern.substr(open + kId.size());
  if (path.size() <= before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after)) {
    return std::nullopt;
  }
  const std::string_view id = path.substr(before.size(), path.size() - before.size() - after.size());
  return id.find('/') == std::string_view::npos ? std::optional(id) : std::nullopt;
}

}  // namespace

std::span<const Route> Routes() { return kRoutes; }

Match FindRoute(std::string_view method, std::string_view path) {
  Match match;
  for (const Route& route : kRoutes) {
    const auto id = MatchPath(route.path, path);
    if (!id) continue;
    match.allowed += (match.allowed.empty() ? "" : ", ") + std::string(route.method);
    if (route.method == "GET") match.allowed += ", HEAD";
    if (route.method != method) continue;
    match.route = &route;
    match.id = *id;
  }
  return match;
}

std::string_view PatternOf(std::string_view path) {
  for (const Route& route : kRoutes) {
    if (MatchPath(route.path, path)) return route.path;
  }
  return "other";
}

}  // namespace pendulum
