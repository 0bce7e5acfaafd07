// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// What takes the energy of a motion, L names: "viscous", "drag" and so on are the parameters of the law whose torque
/// grows with the rate; "dry", the last, stands for all its other torques, if it has any.
std::vector<std::string> LossNames(const MotionModel& model);

/// Where the energy of a part of a motion went. M: the parameters of the motion, see ComputeEnergyLosses.
struct LossShares {
  double energy = 0;         ///< What was lost altogether, in units of the restoring torque G; positive.
  Eigen::VectorXd share;     ///< L, in the order of LossNames; their sum is 1.
  Eigen::MatrixXd gradient;  ///< L x M, of the shares. Release and end of the motion are shifted together.
};

/// The losses of a motion from its start to options.end, and of its first whole half swing, which begins at the release
/// or at a reversal. Absent if less than a millionth of the energy is lost, or if there is no whole half swing.
struct EnergyLosses {
  std::optional<LossShares> whole, first_half_swing;
};

/// Integrates the power of each torque along a trajectory (MODEL.md eq. (6.21)). motion: M numbers, those of
/// PhysicalParameters(model) in units of the restoring torque G, then release_angle [rad] and release_time [s], or
/// initial_angle and initial_rate [rad/s]. Errors as MakeTrajectory.
Result<EnergyLosses> ComputeEnergyLosses(const MotionModel& model, StartKind start, std::span<const double> motion,
                                         const TraceOptions& options);

}  // namespace pendulum
