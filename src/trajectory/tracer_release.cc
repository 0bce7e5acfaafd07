// SPDX-License-Identifier: Apache-2.0
// Compiles trajectories with derivatives by inertia, friction and the angle of a release.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

[[gnu::used]] const TracersOfAllLaws<ReleaseDual> kReleaseTracers;

}  // namespace
}  // namespace pendulum
