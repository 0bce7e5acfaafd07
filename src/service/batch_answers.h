// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/service_state.h"

/// Answers to requests about batches (openapi.json), one function per method of a path.
namespace pendulum {

HttpResponse PostBatch(ServiceState& state, const Call& call);
HttpResponse ListBatches(ServiceState& state, const Call& call);
HttpResponse GetBatch(ServiceState& state, const Call& call);
HttpResponse GetBatchAgreement(ServiceState& state, const Call& call);
HttpResponse GetBatchEvents(ServiceState& state, const Call& call);
HttpResponse DeleteBatch(ServiceState& state, const Call& call);

}  // namespace pendulum
