// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "pendulum/closed_form/decrement.h"
#include "pendulum/closed_form/log_decrement.h"
#include "pendulum/closed_form/peaks.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// All that the turning points of a recording tell in closed form, in true seconds (clock_scale) but for their times.
struct ClosedForms {
  Gravity gravity = Gravity::kSine;    ///< Of the model.
  PeakTable table;                     ///< Its peaks' times are on the file's own clock.
  std::vector<DecayRow> decay;         ///< One for each turning point.
  std::optional<LogDecrement> linear;  ///< The textbook's formulas; nothing without a whole period.
  std::optional<Decrement> decrement;  ///< Exact at any amplitude, with the model's friction.
  std::string no_decrement;            ///< Why there is none.
  std::string wrong_law;               ///< How the turning points exclude the model's friction law; empty: they do not.
  std::vector<EnvelopeLaw> envelopes;  ///< Each term of friction alone; empty where they cannot be told.
  std::string envelope;                ///< Which of them the amplitudes follow, a sentence.
};

/// kFailedPrecondition: as LocatePeaks. kTryAgain: a stop was requested before they were done.
Result<ClosedForms> EstimateClosedForms(const Recording& recording, const MotionModel& model,
                                        const std::stop_token& stop = {});

}  // namespace pendulum
