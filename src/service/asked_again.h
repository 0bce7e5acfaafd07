// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "service/service_state.h"

namespace pendulum {

/// Answers a request that changes something once for each idempotency key it comes with: what is asked again, in the
/// same words, gets the answer that it got, and what is asked in other words, or meanwhile, is refused. `answer` makes
/// the answer and keeps the key with what it keeps; there is none without a key.
HttpResponse AnswerOnce(ServiceState& state, const Call& call,
                        const std::function<HttpResponse(const std::optional<RequestKey>&)>& answer);

}  // namespace pendulum
