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

/// The motion that a fit found, to be followed at any instants, with another gravity or other parameters.
class FittedMotion {
 public:
  /// `used` is what was fitted. Once a stop is requested, there are no readings any more.
  FittedMotion(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig, std::stop_token stop = {});

  /// The recording's instants, true s from its first sample.
  const Eigen::VectorXd& instants() const { return instants_; }

  double small_angle_period() const;  ///< true s

  /// The same start, zero and parameters with that gravity.
  FittedMotion WithGravity(Gravity gravity) const;

  bool drifts() const { return zero_motion_ == ZeroMotion::kDrifts; }

  /// The same with a zero that stays where it is at first.
  FittedMotion WithoutDrift() const;

  /// The same start and zero with viscous friction alone: inertia [s^2] and viscous [s], as its report, in units of G.
  FittedMotion WithViscous(double inertia, double viscous) const;

  /// The readings at instants (N, s from the first sample, increasing), rad or rad/s; and unless null their N x P
  /// derivatives, in the units of the fit's report; edges lag as they were crossed at the recording's own instants, as
  /// the motion goes at others. Nothing when the motion cannot be traced.
  std::optional<Eigen::VectorXd> Readings(const Eigen::VectorXd& instants, Eigen::MatrixXd* jacobian = nullptr) const;

  /// The motion over the recording; nothing when it cannot be traced.
  std::optional<Trajectory> Trace() const;

 private:
  /// Which way edges are behind; false where the motion cannot be traced.
  bool SetLags(TrajectoryData& data) const;

  MotionModel model_;
  StartKind start_;
  Quantity quantity_;
  SensorModel sensor_;
  ZeroMotion zero_motion_ = ZeroMotion::kNone;
  std::vector<double> parameters_;  // P, units of G, times from the first sample
  std::vector<double> reported_;    // P: report's unit per unit of parameters_
  Eigen::VectorXd instants_;
  std::vector<double> against_;  // N, of edges that lag: what their lag multiplies at the recording's instants
  std::stop_token stop_;
};

}  // namespace pendulum
