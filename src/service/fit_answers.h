// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/service_state.h"

/// Answers to requests about single fits (openapi.json), one function per method of a path.
namespace pendulum {

HttpResponse PostFit(ServiceState& state, const Call& call);
HttpResponse PostRefit(ServiceState& state, const Call& call);
HttpResponse ListFits(ServiceState& state, const Call& call);
HttpResponse GetFit(ServiceState& state, const Call& call);
HttpResponse RenameFit(ServiceState& state, const Call& call);
HttpResponse DeleteFit(ServiceState& state, const Call& call);
HttpResponse GetFitRequest(ServiceState& state, const Call& call);
HttpResponse GetRecording(ServiceState& state, const Call& call);
HttpResponse GetSamples(ServiceState& state, const Call& call);
HttpResponse GetSeries(ServiceState& state, const Call& call);
HttpResponse PostReadings(ServiceState& state, const Call& call);
HttpResponse GetSections(ServiceState& state, const Call& call);
HttpResponse GetResiduals(ServiceState& state, const Call& call);
HttpResponse GetReport(ServiceState& state, const Call& call);
HttpResponse GetMarkdown(ServiceState& state, const Call& call);

}  // namespace pendulum
