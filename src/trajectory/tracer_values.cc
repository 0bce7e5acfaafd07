// SPDX-License-Identifier: Apache-2.0
// Compiles trajectories without derivatives.
#include "trajectory/tracer.h"

namespace pendulum {
namespace {

template <typename F>
using NumberOfValues = double;

[[gnu::used]] const TracersOfAllLaws<NumberOfValues> kValuesTracers;

}  // namespace
}  // namespace pendulum
