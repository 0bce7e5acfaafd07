// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/half_swings.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The energy lost between turning points, as a linear least squares for the parameters of a friction law that is
/// linear in them but for a reference rate, at any amplitude (MODEL.md eq. (22)). After Feeny & Liang, J. Sound Vib.
/// 195:149 (1996) and sequels.
struct EnergyBalance {
  Eigen::MatrixXd normal;     ///< K x K, normal equations over the accumulated losses, K friction parameters.
  Eigen::VectorXd right;      ///< K
  double reference_rate = 0;  ///< rad/s, at which the law is linear in the other parameters; 0 where it has none.
};

/// One balance; of a law with a reference rate one for each of its kRateScales, the one that explains most first.
std::vector<EnergyBalance> BalanceEnergy(const MotionModel& model, const HalfSwingTable& table,
                                         double natural_frequency);

/// K friction parameters >= 0 (in units of G) that balance best, good to some percent; 0 where `left_out` (K, or none).
std::vector<double> FrictionFrom(const EnergyBalance& balance, const std::vector<bool>& left_out = {});

}  // namespace pendulum
