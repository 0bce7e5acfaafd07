// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pendulum/closed_form/half_swings.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// Friction parameters (in units of G) from the energy lost between turning points.
///
/// At a turning point the energy is U = 1 - cos A; between two, friction takes ∫ T(ω(θ)) dθ with ω(θ) = ω0 sqrt(2 (cos
/// θ - cos A)) and A the mean amplitude (MODEL.md eq. (22)). That is linear in the parameters of a law that is linear
/// in them, so they follow from one linear least squares with parameters >= 0 over the accumulated losses; it holds at
/// any amplitude. After Feeny & Liang, J. Sound Vib. 195:149 (1996) and their energy-balance sequels. Good to some
/// percent.
std::vector<double> FrictionFromEnergyBalance(const MotionModel& model, const HalfSwingTable& table,
                                              double natural_frequency);

}  // namespace pendulum
