// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/half_swings.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The energy lost between turning points, as a linear least squares for the parameters of a friction law.
///
/// At a turning point the energy is U = 1 - cos A; between two, friction takes ∫ T(ω(θ)) dθ with ω(θ) = ω0 sqrt(2 (cos
/// θ - cos A)) and A the mean amplitude (MODEL.md eq. (22)). That is linear in the parameters of a law that is linear
/// in them, and holds at any amplitude. After Feeny & Liang, J. Sound Vib. 195:149 (1996) and their energy-balance
/// sequels.
struct EnergyBalance {
  Eigen::MatrixXd normal;  ///< K x K, normal equations over the accumulated losses, K friction parameters.
  Eigen::VectorXd right;   ///< K
};

EnergyBalance BalanceEnergy(const MotionModel& model, const HalfSwingTable& table, double natural_frequency);

/// The K friction parameters >= 0 (in units of G) that balance best, those marked in `left_out` (K, or none) being 0.
/// Good to some percent.
std::vector<double> FrictionFrom(const EnergyBalance& balance, const std::vector<bool>& left_out = {});

}  // namespace pendulum
