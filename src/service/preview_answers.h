// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/service/http.h"
#include "service/service_state.h"

namespace pendulum {

/// POST /v1/previews: what a fit of the same request would read, without the fit.
HttpResponse PostPreview(ServiceState& state, const Call& call);

}  // namespace pendulum
