// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// The law of gravity's torque in units of G: sin θ, or θ for the small-angle model.  MODEL.md eq. (5), (6).
enum class Gravity { kSine, kLinear };

/// What --model chooses: a friction law and a gravity law.
struct MotionModel {
  std::string_view name;      ///< The value of --model.
  std::string_view friction;  ///< A name in FrictionModels.
  Gravity gravity;
};

/// `linear` (viscous friction, linear gravity) and one model of sine gravity for each registered friction law.
std::vector<MotionModel> MotionModels();

/// The model of that name. kInvalidArgument: there is none; the message lists those there are.
Result<MotionModel> FindMotionModel(std::string_view name);

/// The models of a list, "viscous,coulomb", in its order; "all" is one of each friction law.
/// kInvalidArgument: a name that is no model's, is empty, or stands twice.
Result<std::vector<MotionModel>> FindMotionModels(std::string_view names);

/// Inertia and the parameters of the model's friction law, in the order the trajectory takes them.
std::vector<ParameterInfo> PhysicalParameters(const MotionModel& model);

/// The names of all motion models, comma-separated, for messages and help.
std::string MotionModelNames();

}  // namespace pendulum
