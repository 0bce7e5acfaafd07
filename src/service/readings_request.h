// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <string>

#include <nlohmann/json.hpp>

#include "pendulum/identify/identification.h"
#include "pendulum/model/parameter.h"
#include "pendulum/service/fit_request.h"

namespace pendulum {

/// The readings of a fit that a client asks for.
struct ReadingsRequest {
  ParameterValues values;
  std::string model;          ///< Empty: the main fit.
  std::size_t recording = 0;  ///< From 0.
};

/// Reads the body {"parameters": {"inertia": 0.08}, "model": "coulomb", "recording": 0}; the last two may be missing.
/// Problems: another content type or member; a value that is not a number.
ResultOrProblem<ReadingsRequest> ParseReadingsRequest(const HttpRequest& http);

/// The readings of ReadingsAt as {"time_s", "value", "unit", "rms_residual"}: every k-th sample, at most 4000, times on
/// the file's clock, and the root mean square of measured - value of these samples. kInvalidArgument: no fit has this
/// model, there is no such recording, and errors of ReadingsAt. kNotFound: the run has no fit. kTryAgain: stopped.
Result<nlohmann::ordered_json> ReadingsJson(const Identification& run, const ReadingsRequest& request,
                                            const std::stop_token& stop);

}  // namespace pendulum
