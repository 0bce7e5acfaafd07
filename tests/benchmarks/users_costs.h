// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <ceres/cost_function.h>

#include "pendulum/recording/recording.h"

/// Cost functions over a recording as Ceres' users write them; it must outlive them. Each is in the file of its name,
/// alone and compiled apart: how many of Eigen's operations on Jets g++ inlines hangs on what else is in a file, and
/// the time of one Jacobian with it.
namespace pendulum::benchmarks {

std::unique_ptr<ceres::CostFunction> MakeSmoothedRk4Cost(const Recording& recording);
std::unique_ptr<ceres::CostFunction> MakeLocatedRk4Cost(const Recording& recording);

/// The same with every call inlined by [[gnu::flatten]], which hardly any user knows.
std::unique_ptr<ceres::CostFunction> MakeSmoothedRk4FlattenedCost(const Recording& recording);
std::unique_ptr<ceres::CostFunction> MakeLocatedRk4FlattenedCost(const Recording& recording);

/// To 1e-6 rad; flattened too.
std::unique_ptr<ceres::CostFunction> MakeLocatedOdeintCost(const Recording& recording);

}  // namespace pendulum::benchmarks
