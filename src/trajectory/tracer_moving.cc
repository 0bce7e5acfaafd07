// SPDX-License-Identifier: Apache-2.0
// Compiles trajectories with derivatives with respect to inertia, friction, initial angle and initial rate.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

[[gnu::used]] const TracersOfAllLaws<MovingDual> kMovingTracers;

}  // namespace
}  // namespace pendulum
