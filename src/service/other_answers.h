// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/service_state.h"

/// Answers to all other requests (openapi.json), one function per method of a path: simulations, calibrations, models,
/// examples, the live recording, the service itself, its page and the user guide.
namespace pendulum {

HttpResponse PostSimulation(ServiceState& state, const Call& call);
HttpResponse PostCalibration(ServiceState& state, const Call& call);
HttpResponse GetModels(ServiceState& state, const Call& call);
HttpResponse ListExamples(ServiceState& state, const Call& call);
HttpResponse GetExample(ServiceState& state, const Call& call);
HttpResponse GetLive(ServiceState& state, const Call& call);
HttpResponse GetLiveEvents(ServiceState& state, const Call& call);
HttpResponse GetLiveRecording(ServiceState& state, const Call& call);
HttpResponse GetHealth(ServiceState& state, const Call& call);
HttpResponse GetMetrics(ServiceState& state, const Call& call);
HttpResponse GetOpenApi(ServiceState& state, const Call& call);
HttpResponse GetPage(ServiceState& state, const Call& call);
HttpResponse GetScript(ServiceState& state, const Call& call);
HttpResponse GetStyle(ServiceState& state, const Call& call);
HttpResponse GetGuide(ServiceState& state, const Call& call);
HttpResponse GetGuideFile(ServiceState& state, const Call& call);

}  // namespace pendulum
