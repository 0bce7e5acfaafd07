// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

struct TrajectoryData;

/// The motion that a fit found. It can be evaluated at any instants, with another gravity or other parameters.
class FittedMotion {
 public:
  /// `used` holds the fitted samples. After a stop request, Readings returns std::nullopt.
  FittedMotion(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig, std::stop_token stop = {});

  /// The recording's time stamps, true s from its first sample.
  const Eigen::VectorXd& instants() const { return instants_; }

  double small_angle_period() const;  ///< true s

  /// The same start, zero and parameters with another gravity.
  FittedMotion WithGravity(Gravity gravity) const;

  bool drifts() const { return zero_motion_ == ZeroMotion::kDrifts; }

  /// The same motion with the zero fixed at its initial value.
  FittedMotion WithoutDrift() const;

  /// The same fit with other parameters: P values in the order and the units of its report.
  FittedMotion WithValues(const std::vector<double>& values) const;

  /// The same start and zero with only viscous friction: inertia [s^2] and viscous [s], in units of the restoring
  /// torque G.
  FittedMotion WithViscous(double inertia, double viscous) const;

  /// The readings at instants (N, s from the first sample, increasing), rad or rad/s, and optionally their N x P
  /// derivatives, in the units of the fit's report. At the recording's own instants edges lag in the direction in which
  /// they were crossed; at other instants, in the direction of the motion. std::nullopt: the trajectory cannot be
  /// computed.
  std::optional<Eigen::VectorXd> Readings(const Eigen::VectorXd& instants, Eigen::MatrixXd* jacobian = nullptr) const;

  /// The trajectory over the recording; std::nullopt if it cannot be computed.
  std::optional<Trajectory> Trace() const;

 private:
  /// Sets the direction in which edges lag; false if the trajectory cannot be computed.
  bool SetLags(TrajectoryData& data) const;

  MotionModel model_;
  StartKind start_;
  Quantity quantity_;
  SensorModel sensor_;
  ZeroMotion zero_motion_ = ZeroMotion::kNone;
  std::vector<double> parameters_;  // P, units of the restoring torque G, times from the first sample
  // P: reported value = reported_ · parameter + offset_.
  std::vector<double> reported_, offset_;
  Eigen::VectorXd instants_;
  std::vector<double> against_;  // N, only for edges that lag: factor of the lag at the recording's instants.
  std::stop_token stop_;
};

}  // namespace pendulum
