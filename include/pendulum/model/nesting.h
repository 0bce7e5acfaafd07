// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The parameters that a richer friction law adds to a simpler one. The simpler law is the null hypothesis: the richer
/// law reduces to it at special values of these parameters.
struct Nesting {
  std::vector<ParameterInfo> added;
  int bounded = 0;  ///< How many are at a bound under the null: a torque that is 0 or equal to another torque.
  int free = 0;     ///< How many are within their bounds under the null.
  std::vector<std::string_view> unidentified;  ///< Without effect under the null; not in `bounded` or `free`.
};

/// How `simpler` is nested in `richer`: all its parameters also occur there, and the gravity law is the same.
/// std::nullopt if it is not nested.
std::optional<Nesting> FindNesting(const MotionModel& simpler, const MotionModel& richer);

/// The nested model with the most parameters; std::nullopt if no model is nested in this one.
std::optional<MotionModel> LargestNestedModel(const MotionModel& model);

/// Indices into PhysicalParameters of two parameters, of which the law requires that one is never below the other. Both
/// are negative if the law has no such pair.
OrderedPair FindOrderedPair(const MotionModel& model);

}  // namespace pendulum
