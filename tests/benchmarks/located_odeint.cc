// SPDX-License-Identifier: Apache-2.0
#include "ceres_users.h"
#include "odeint_swing.h"
#include "users_costs.h"

namespace pendulum::benchmarks {

/// Always flattened, so that the ready-made integrator shows its best time.
std::unique_ptr<ceres::CostFunction> MakeLocatedOdeintCost(const Recording& recording) {
  return MakeUsersCost<FlattenedResiduals<OdeintSwing>>(recording);
}

}  // namespace pendulum::benchmarks
