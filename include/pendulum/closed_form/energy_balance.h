// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/half_swings.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The energy lost between turning points, as a linear least squares for the parameters of a friction law that is
/// linear in them, at any amplitude (MODEL.md eq. (22)). After Feeny & Liang, J. Sound Vib. 195:149 (1996) and sequels.
struct EnergyBalance {
  Eigen::MatrixXd normal;  ///< K x K, normal equations over the accumulated losses, K friction parameters.
  Eigen::VectorXd right;   ///< K
};

EnergyBalance BalanceEnergy(const MotionModel& model, const HalfSwingTable& table, double natural_frequency);

/// K friction parameters >= 0 (in units of G) that balance best, good to some percent; 0 where `left_out` (K, or none).
std::vector<double> FrictionFrom(const EnergyBalance& balance, const std::vector<bool>& left_out = {});

}  // namespace pendulum
