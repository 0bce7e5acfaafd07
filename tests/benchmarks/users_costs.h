// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <ceres/cost_function.h>

#include "pendulum/recording/recording.h"

/// Cost functions over a recording as users of Ceres write them; the recording must outlive them. Each is alone in a
/// file with its name and compiled separately. The number of Jet operations that g++ inlines, and so the time of a
/// Jacobian, depends on the rest of the file.
namespace pendulum::benchmarks {

std::unique_ptr<ceres::CostFunction> MakeSmoothedRk4Cost(const Recording& recording);
std::unique_ptr<ceres::CostFunction> MakeLocatedRk4Cost(const Recording& recording);

/// The same with every call inlined by [[gnu::flatten]], which few users know.
std::unique_ptr<ceres::CostFunction> MakeSmoothedRk4FlattenedCost(const Recording& recording);
std::unique_ptr<ceres::CostFunction> MakeLocatedRk4FlattenedCost(const Recording& recording);

/// Accurate to 1e-6 rad; also flattened.
std::unique_ptr<ceres::CostFunction> MakeLocatedOdeintCost(const Recording& recording);

}  // namespace pendulum::benchmarks
