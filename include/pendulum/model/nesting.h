// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "pendulum/model/motion_model.h"

namespace pendulum {

/// What a richer friction law has beyond a simpler one that is a special case of it (the null).
struct Nesting {
  std::vector<ParameterInfo> added;
  int bounded = 0;  ///< Of the added: at their bound under the null, a torque of 0 or one no larger than another.
  int free = 0;     ///< Within their bounds under the null.
  std::vector<std::string_view> unidentified;  ///< Those of no effect under the null, not counted above.
};

/// How `simpler` is nested in `richer`: it has some of the same parameters and the same gravity. Nothing when it is
/// not.
std::optional<Nesting> FindNesting(const MotionModel& simpler, const MotionModel& richer);

/// The richest model nested in this one; nothing when there is none.
std::optional<MotionModel> RichestWithin(const MotionModel& model);

/// Indices among PhysicalParameters of a parameter that is at least another; negative where the law has no such pair.
OrderedPair OrderOf(const MotionModel& model);

}  // namespace pendulum
