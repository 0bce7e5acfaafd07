// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/status.h"
#include "pendulum/model/gravity/gravity.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// A model as --model selects it: a friction law and a gravity law.
struct MotionModel {
  std::string_view name;      ///< The name that --model takes.
  std::string_view friction;  ///< A name in FrictionModels.
  Gravity gravity;
};

/// All models: each friction law with each law of gravity, in the order of the registries. A friction law with a
/// constant torque (asymmetric) is not combined with linear gravity, where this torque would only shift the zero. With
/// the default gravity, sin, a model has the name of its friction law. Other models are called GRAVITY_FRICTION, such
/// as linear_coulomb; GRAVITY alone means viscous friction.
std::vector<MotionModel> MotionModels();

/// The model with this name or a usual word for its friction law, such as "dry" for coulomb. kInvalidArgument: there is
/// none; the message lists the existing names.
Result<MotionModel> FindMotionModel(std::string_view name);

/// The models of a comma-separated list such as "viscous,coulomb", in its order. "all" means one model for each
/// friction law, with the default gravity. `gravity`, if given, replaces the default gravity: coulomb with linear
/// gravity is linear_coulomb. kInvalidArgument: a name is unknown, empty or repeated, or its law contradicts `gravity`.
Result<std::vector<MotionModel>> FindMotionModels(std::string_view names, std::optional<Gravity> gravity = {});

/// The model with the same friction law and this law of gravity; std::nullopt if a fit could not determine it.
std::optional<MotionModel> WithGravity(const MotionModel& model, Gravity gravity);

/// The inertia and the parameters of the model's friction law, in the order in which trajectories take them.
std::vector<ParameterInfo> PhysicalParameters(const MotionModel& model);

/// Every parameter that a fit can have, once: those of all models, then those of recordings.
std::vector<ParameterInfo> AllParameters();

/// The names of all motion models, comma-separated, for messages and help.
std::string MotionModelNames();

}  // namespace pendulum
