// SPDX-License-Identifier: Apache-2.0
// Trajectories with derivatives by inertia, friction, and the angle and rate of a start in motion.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

template <typename F>
using NumberOfMoving = Dual<kFrictionParameters<F> + 3>;

[[gnu::used]] const TracersOfAllLaws<NumberOfMoving> kMovingTracers;

}  // namespace
}  // namespace pendulum
