// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/service/http.h"

namespace pendulum {

inline constexpr std::size_t kLongestIdempotencyKey = 255;  ///< bytes

/// The Idempotency-Key of a request, unchanged; empty if there is none.
/// kInvalidArgument: it is repeated, empty, longer than kLongestIdempotencyKey, or has characters other than visible
/// ASCII.
Result<std::string> IdempotencyKey(const HttpRequest& request);

}  // namespace pendulum
