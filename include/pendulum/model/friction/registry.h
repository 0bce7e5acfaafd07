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

namespace pendulum {

/// All friction laws. To add one, include its header above and add its name here (CONTRIBUTING.md describes the rest).
using FrictionModels = FrictionModelList<ViscousFriction, CoulombFriction, DragFriction, StribeckFriction,
                                         AsymmetricFriction, DahlFriction, LoadFriction>;

}  // namespace pendulum
