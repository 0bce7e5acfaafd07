// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/base/warning.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/model/gravity/gravity.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Small swings that are faster than larger ones, as if a spring were added to gravity. Before a bearing slides, its
/// friction acts like such a spring, as in the law dahl.
struct Presliding {
  double from = 0;       ///< s, file's clock: the turning point from which on swings are clearly faster.
  double amplitude = 0;  ///< Of that turning point, in the unit of the readings.
  double faster = 0;     ///< By how much the last swings are faster, relative.
};

/// Looks for presliding in the readings of an angle or a rate. With sine gravity, the longer period of large swings is
/// taken into account, and so is the scatter of the durations. std::nullopt without presliding, for readings that are
/// not calibrated, and if less than four half swings would remain.
std::optional<Presliding> FindPresliding(const Recording& used, Gravity gravity);

/// is_left_out: the window ends before.
Warning WarningOf(const Presliding& presliding, const std::string& unit, bool is_left_out);

}  // namespace pendulum
