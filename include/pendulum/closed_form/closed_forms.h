// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "pendulum/closed_form/log_decrement.h"
#include "pendulum/closed_form/turning_point_fit.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// All closed-form results from the turning points of a recording. Everything except the turning points' times is in
/// true seconds (clock_scale).
struct ClosedForms {
  Gravity gravity = Gravity::kSine;          ///< The model's gravity law.
  TurningPointTable table;                   ///< Its times are on the file's own clock.
  std::vector<DecayRow> decay;               ///< One for each turning point.
  std::optional<LogDecrement> linear;        ///< By the textbook's formulas; std::nullopt without a whole period.
  std::optional<TurningPointFit> decrement;  ///< Valid at any amplitude, with the model's friction.
  std::string no_decrement;                  ///< Why `decrement` is missing.
  std::string wrong_law;                     ///< How the turning points exclude the model's friction law, or empty.
  std::vector<EnvelopeLaw> envelopes;        ///< One for each friction term alone; empty if they cannot be compared.
  std::string envelope;                      ///< A sentence that says which of these laws the amplitudes follow.
};

/// Computes all closed forms. kFailedPrecondition: as LocateTurningPoints, or an uncalibrated reading for a model with
/// sine gravity. kTryAgain: a stop was requested before the end.
Result<ClosedForms> EstimateClosedForms(const Recording& recording, const MotionModel& model,
                                        const std::stop_token& stop = {});

}  // namespace pendulum
