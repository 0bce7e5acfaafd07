// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/service/http.h"

namespace pendulum {

/// The kind of a problem. Each kind has a code, a title, an HTTP status and, if the command line has the same error, an
/// exit code.
enum class ProblemKind {
  kWrongRequest,          ///< 400
  kUnauthorized,          ///< 401
  kForbidden,             ///< 403
  kNotFound,              ///< 404
  kMethodNotAllowed,      ///< 405
  kTimedOut,              ///< 408
  kConflict,              ///< 409
  kTooLarge,              ///< 413
  kUnsupportedMediaType,  ///< 415
  kExpectationFailed,     ///< 417
  kUnusableData,          ///< 422
  kNoSwing,               ///< 422
  kKeyReused,             ///< 422
  kTooManySamples,        ///< 422
  kTooManyRequests,       ///< 429
  kHeadersTooLarge,       ///< 431
  kInternal,              ///< 500
  kStopping,              ///< 503
  kCannotWrite,           ///< 507
};

/// Problem details (RFC 9457).
struct Problem {
  ProblemKind kind = ProblemKind::kInternal;
  std::string detail;                       ///< A sentence, the same as on the command line.
  std::vector<HttpField> fields;            ///< Additional fields of the answer: Allow, Retry-After, WWW-Authenticate.
  std::vector<std::string> try_flags = {};  ///< As in Status.

  int status() const;             ///< 422
  std::string_view code() const;  ///< "unusable_data"
};

/// Default time after which a client may try again.
inline constexpr std::chrono::seconds kRetryAfter{5};

/// Converts the error of a function. kTryAgain becomes kStopping, with Retry-After.
Problem ProblemOf(const Status& status);

/// A problem for an HTTP status (400, 404, 408, 413, 415, 417, 429, 431, 503), with Retry-After if a later attempt may
/// succeed. Any other status below 500 becomes 400, any other from 500 on becomes 500.
Problem ProblemOf(int http_status, std::string detail);

/// 401. `error`: as in RFC 6750, section 3.1, such as invalid_token; empty if the request has no token.
Problem Unauthorized(std::string detail, std::string_view error = "");

/// 405 for a resource with the methods `allowed`: "GET, HEAD".
Problem MethodNotAllowed(std::string_view method, std::string_view allowed);

/// A problem with Retry-After, in whole seconds, at least 1: kTimedOut, kTooManyRequests, kStopping; kConflict while
/// another request with the same key runs.
Problem RetryLater(ProblemKind kind, std::string detail, std::chrono::seconds after = kRetryAfter);

/// The flags "--name value" as parameters of a request: {"name": "value"}; a flag without a value is true.
nlohmann::ordered_json TryParameters(const std::vector<std::string>& flags);

/// application/problem+json: {"type": "urn:pendulum:problem:CODE", "title", "status", "detail", "code", "exit_code"},
/// on one line; if there are flags to try, also "try": {"unit": "deg"}. Bytes of the detail that are not valid UTF-8
/// become U+FFFD.
HttpResponse ProblemResponse(const Problem& problem);

}  // namespace pendulum
