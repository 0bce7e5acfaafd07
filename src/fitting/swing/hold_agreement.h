// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// How the readings of a hold differ from those that follow from the swing after it. A hand may hold the pendulum at
/// another angle before it lets go, move during the hold, push or brake at the release.
struct HoldDisagreement {
  double offset = 0;        ///< Unit of the readings: the mean of the hold minus what the swing says.
  double offset_error = 0;  ///< Standard error of the offset.
  double creep = 0;         ///< Unit of the readings: by how much the readings change during the hold.
  double creep_error = 0;   ///< Standard error of the creep.
};

/// Tests a converged fit that begins with a release: whether an offset and a creep of the hold, as two more parameters,
/// would improve it, by Rao's score test with the noise of the swing alone (MODEL.md section 6, "Does the hold agree
/// with the swing?"). Returns std::nullopt if the hold agrees (p > 1e-6), has fewer than eight samples, or cannot be
/// tested: events, and readings of neither an angle nor a rate. Cost: one trajectory with its sensitivities.
std::optional<HoldDisagreement> FindHoldDisagreement(const Recording& used, const FitReport& fit,
                                                     const FitOptions& options);

/// "its readings are 0.007 rad above those that the swing after it predicts, and they creep by 0.0002 rad".
std::string Sentence(const HoldDisagreement& disagreement, const Recording& used);

}  // namespace pendulum
