// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/model/rig.h"

namespace pendulum {

/// Adds to the derived quantities of a fit those that this rig makes known (MODEL.md eq. (6.16)):
///   a length            gravity g = (G/I) l
///   g                   effective_length g / (G/I), unless the rig gives a rod and a bob or a centre of mass
///   both                inertia_per_mass g l / (G/I)
///   a known inertia I   gravity_torque (G/I) I, or stiffness if the model is linear; viscous_si, coulomb_si ... [SI];
///                       with mass and g center_of_mass (G/I) I / (m g)
/// Each has a standard error from the fit, and a systematic one from the errors of rig, clock and calibration.
void AddRigQuantities(const Rig& rig, FitReport& fit);

}  // namespace pendulum
