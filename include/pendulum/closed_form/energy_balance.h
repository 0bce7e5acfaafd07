// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/turning_points.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The energy lost between turning points, as linear least squares for the friction parameters, at any amplitude
/// (MODEL.md eq. (6.3)). The law must be linear in its parameters except a reference. After Feeny & Liang, J.
/// Sound Vib. 195:149 (1996) and sequels.
struct EnergyBalance {
  Eigen::MatrixXd normal;  ///< K x K, normal equations of the accumulated losses for K friction parameters.
  Eigen::VectorXd right;   ///< K
  double reference = 0;    ///< rad/s or rad; with it the law is linear in the other parameters. 0 if the law has none.
};

/// One balance. For a law with a reference: one balance for each of its kRateScales or kAngleScales, sorted by how well
/// they explain the losses, best first.
std::vector<EnergyBalance> BalanceEnergy(const MotionModel& model, const TurningPointTable& table,
                                         double natural_frequency);

/// The K friction parameters >= 0 (units of the restoring torque G) that balance the energy best, accurate to some
/// percent. Parameters marked in `left_out` (K, or empty) are 0.
std::vector<double> FrictionFrom(const EnergyBalance& balance, const std::vector<bool>& left_out = {});

}  // namespace pendulum
