// SPDX-License-Identifier: Apache-2.0
#include "pendulum/service/problem.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/json.h"

namespace pendulum {
namespace {

/// The common properties of a kind of problems.
struct KindOfProblem {
  ProblemKind kind;
  int status;
  std::string_view code, title;
  std::optional<int> exit_code;
};

/// In the order of ProblemKind.
constexpr std::array kKindsOfProblem = {
    KindOfProblem{ProblemKind::kWrongRequest, 400, "bad_request", "The request is wrong", 2},
    KindOfProblem{ProblemKind::kUnauthorized, 401, "unauthorized", "The request needs a token", {}},
    KindOfProblem{ProblemKind::kForbidden, 403, "forbidden", "The request is not allowed", {}},
    KindOfProblem{ProblemKind::kNotFound, 404, "not_found", "Not found", 3},
    KindOfProblem{ProblemKind::kMethodNotAllowed, 405, "method_not_allowed", "The method is not allowed", {}},
    KindOfProblem{ProblemKind::kTimedOut, 408, "timed_out", "The request timed out", 75},
    KindOfProblem{ProblemKind::kConflict, 409, "conflict", "The request conflicts with the current state", {}},
    KindOfProblem{ProblemKind::kTooLarge, 413, "too_large", "The request is too large", 4},
    KindOfProblem{
        ProblemKind::kUnsupportedMediaType, 415, "unsupported_media_type", "The content type is not supported", {}},
    KindOfProblem{ProblemKind::kExpectationFailed, 417, "expectation_failed", "The expectation cannot be met", {}},
    KindOfProblem{ProblemKind::kUnusableData, 422, "unusable_data", "The data cannot be read", 4},
    KindOfProblem{ProblemKind::kNoSwing, 422, "no_swing", "The data contain no swing that can be fitted", 5},
    KindOfProblem{ProblemKind::kKeyReused, 422, "idempotency_key_reused", "The key belongs to another request", {}},
    KindOfProblem{ProblemKind::kTooManySamples, 422, "too_many_samples", "The fit has too many samples for this", {}},
    KindOfProblem{ProblemKind::kTooManyRequests, 429, "too_many_requests", "Too many requests at the same time", 75},
    KindOfProblem{ProblemKind::kHeadersTooLarge, 431, "headers_too_large", "The head of the request is too large", {}},
    KindOfProblem{ProblemKind::kInternal, 500, "internal", "The service has failed", 70},
    KindOfProblem{ProblemKind::kStopping, 503, "stopping", "The service is not available now", 75},
    KindOfProblem{ProblemKind::kCannotWrite, 507, "cannot_write", "The result cannot be stored", 73},
};

static_assert(std::ranges::is_sorted(kKindsOfProblem, {}, &KindOfProblem::kind));

const KindOfProblem& KindOf(ProblemKind kind) { return kKindsOfProblem.at(static_cast<std::size_t>(kind)); }

ProblemKind KindOf(StatusCode code) {
  switch (code) {
    case StatusCode::kInvalidArgument: return ProblemKind::kWrongRequest;
    case StatusCode::kNotFound: return ProblemKind::kNotFound;
    case StatusCode::kDataLoss: return ProblemKind::kUnusableData;
    case StatusCode::kFailedPrecondition: return ProblemKind::kNoSwing;
    case StatusCode::kCannotWrite: return ProblemKind::kCannotWrite;
    case StatusCode::kTryAgain: return ProblemKind::kStopping;
    case StatusCode::kInternal: return ProblemKind::kInternal;
  }
  return ProblemKind::kInternal;
}

/// The kind of an HTTP status; kWrongRequest or kInternal if several kinds share the status, or if it is unknown.
ProblemKind KindOfHttpStatus(int status) {
  constexpr int kUnprocessable = 422, kServerErrors = 500;
  const auto* const found = std::ranges::find(kKindsOfProblem, status, &KindOfProblem::status);
  if (found != kKindsOfProblem.end() && status != kUnprocessable) return found->kind;
  return status < kServerErrors ? ProblemKind::kWrongRequest : ProblemKind::kInternal;
}

bool MaySucceedLater(ProblemKind kind) {
  return kind == ProblemKind::kTimedOut || kind == ProblemKind::kTooManyRequests || kind == ProblemKind::kStopping;
}

Problem ProblemOfKind(ProblemKind kind, std::string detail) {
  return MaySucceedLater(kind) ? RetryLater(kind, std::move(detail)) : Problem{kind, std::move(detail), {}};
}

}  // namespace

nlohmann::ordered_json TryParameters(const std::vector<std::string>& flags) {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
  for (const std::string& flag : flags) {
    const std::size_t space = std::min(flag.find(' '), flag.size());
    const std::string name = flag.substr(flag.find_first_not_of('-'), space - flag.find_first_not_of('-'));
    parameters[name] = space == flag.size() ? "true" : flag.substr(space + 1);
  }
  return parameters;
}

int Problem::status() const { return KindOf(kind).status; }

std::string_view Problem::code() const { return KindOf(kind).code; }

Problem ProblemOf(const Status& status) {
  Problem problem = ProblemOfKind(KindOf(status.code), status.message());
  problem.try_flags = status.try_flags;
  return problem;
}

Problem ProblemOf(int http_status, std::string detail) {
  return ProblemOfKind(KindOfHttpStatus(http_status), std::move(detail));
}

Problem Unauthorized(std::string detail, std::string_view error) {
  std::string challenge = "Bearer realm=\"pendulum\"";
  if (!error.empty()) challenge += ", error=\"" + std::string(error) + "\"";
  return {ProblemKind::kUnauthorized, std::move(detail), {{"WWW-Authenticate", std::move(challenge)}}};
}

Problem MethodNotAllowed(std::string_view method, std::string_view allowed) {
  return {ProblemKind::kMethodNotAllowed,
          "the method " + Quoted(method) + " is not allowed here; allowed are " + std::string(allowed),
          {{"Allow", std::string(allowed)}}};
}

Problem RetryLater(ProblemKind kind, std::string detail, std::chrono::seconds after) {
  const auto seconds = std::max(after, std::chrono::seconds{1}).count();
  return {kind, std::move(detail), {{"Retry-After", std::to_string(seconds)}}};
}

HttpResponse ProblemResponse(const Problem& problem) {
  const KindOfProblem& kind = KindOf(problem.kind);
  nlohmann::ordered_json json;
  json["type"] = "urn:pendulum:problem:" + std::string(kind.code);
  json["title"] = kind.title;
  json["status"] = kind.status;
  json["detail"] = problem.detail;
  json["code"] = kind.code;
  json["exit_code"] = kind.exit_code ? nlohmann::ordered_json(*kind.exit_code) : nlohmann::ordered_json(nullptr);
  if (!problem.try_flags.empty()) json["try"] = TryParameters(problem.try_flags);
  HttpResponse response;
  response.status = kind.status;
  response.fields = problem.fields;
  response.fields.push_back({"Content-Type", "application/problem+json"});
  response.body = JsonText(json) + "\n";
  return response;
}

}  // namespace pendulum
