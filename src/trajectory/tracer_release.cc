// SPDX-License-Identifier: Apache-2.0
// Compiles trajectories with derivatives with respect to inertia, friction and release angle.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

[[gnu::used]] const TracersOfAllLaws<ReleaseDual> kReleaseTracers;

}  // namespace
}  // namespace pendulum
