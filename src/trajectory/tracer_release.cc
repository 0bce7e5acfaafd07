// SPDX-License-Identifier: Apache-2.0
// Trajectories with derivatives by inertia, friction and the angle of a release.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

template <typename F>
using NumberOfRelease = Dual<kFrictionParameters<F> + 2>;

[[gnu::used]] const TracersOfAllLaws<NumberOfRelease> kReleaseTracers;

}  // namespace
}  // namespace pendulum
