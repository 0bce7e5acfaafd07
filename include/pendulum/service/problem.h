// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/service/http.h"

namespace pendulum {

/// Why a request has no answer. Each has a code, a title, a status of HTTP and, where the command line knows it too, an
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
  kTooManyRequests,       ///< 429
  kHeadersTooLarge,       ///< 431
  kInternal,              ///< 500
  kStopping,              ///< 503
  kCannotWrite,           ///< 507
};

/// Problem details (RFC 9457).
struct Problem {
  ProblemKind kind = ProblemKind::kInternal;
  std::string detail;             ///< The sentence, as the command line says it.
  std::vector<HttpField> fields;  ///< That the answer has beside its content: Allow, Retry-After, WWW-Authenticate.

  int status() const;             ///< 422
  std::string_view code() const;  ///< "unusable_data"
};

/// After how long a client may ask again, where nobody knows better.
inline constexpr std::chrono::seconds kRetryAfter{5};

/// What a function says, to the world. kTryAgain is kStopping, with Retry-After.
Problem ProblemOf(const Status& status);

/// What HTTP itself refuses (400, 404, 408, 413, 415, 417, 429, 431, 503), with Retry-After where it may succeed later.
/// Any other status below 500 is 400, any other 500.
Problem ProblemOf(int http_status, std::string detail);

/// 401. `error`: of RFC 6750, section 3.1, such as invalid_token; empty where the request has no token at all.
Problem Unauthorized(std::string detail, std::string_view error = "");

/// 405 of a resource that has these methods: "GET, HEAD".
Problem MethodNotAllowed(std::string_view method, std::string_view allowed);

/// With Retry-After, in whole seconds from 1 on: kTimedOut, kTooManyRequests, kStopping; kConflict while the other
/// runs.
Problem RetryLater(ProblemKind kind, std::string detail, std::chrono::seconds after = kRetryAfter);

/// application/problem+json: {"type": "urn:pendulum:problem:CODE", "title", "status", "detail", "code", "exit_code"},
/// on one line. Bytes of the detail that are no UTF-8 become U+FFFD.
HttpResponse ProblemResponse(const Problem& problem);

}  // namespace pendulum
