// SPDX-License-Identifier: Apache-2.0
#include "ceres_users.h"
#include "users_costs.h"

namespace pendulum::benchmarks {

std::unique_ptr<ceres::CostFunction> MakeSmoothedRk4FlattenedCost(const Recording& recording) {
  return MakeUsersCost<FlattenedResiduals<SmoothedSwing>>(recording);
}

}  // namespace pendulum::benchmarks
