// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "service/service_state.h"

namespace pendulum {

/// Processes a request that changes data only once per idempotency key. A repeated identical request gets the first
/// answer. A different request with the same key, or a repetition while the first request runs, is refused. `answer`
/// makes the answer and stores the key with the data; it gets std::nullopt for a request without a key.
HttpResponse AnswerOnce(ServiceState& state, const Call& call,
                        const std::function<HttpResponse(const std::optional<RequestKey>&)>& answer);

}  // namespace pendulum
