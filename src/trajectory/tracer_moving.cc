// SPDX-License-Identifier: Apache-2.0
// Compiles trajectories with derivatives by inertia, friction, and the angle and rate of a start in motion.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

[[gnu::used]] const TracersOfAllLaws<MovingDual> kMovingTracers;

}  // namespace
}  // namespace pendulum
