// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/model/friction/asymmetric.h"
#include "pendulum/model/friction/coulomb.h"
#include "pendulum/model/friction/dahl.h"
#include "pendulum/model/friction/drag.h"
#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/friction/load.h"
#include "pendulum/model/friction/stribeck.h"
#include "pendulum/model/friction/viscous.h"
#include "tests/trajectory/extra_law/wind.h"

namespace pendulum {

/// Takes the place of the registry of include/ in the program of the extra law. It has few laws, to be compiled fast.
using FrictionModels = FrictionModelList<ViscousFriction, CoulombFriction, DragFriction, WindFriction>;

}  // namespace pendulum
