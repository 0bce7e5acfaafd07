// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// One instant of a swing.
struct SwingInstant {
  double angle = 0, rate = 0;  ///< rad, rad/s
  double direction = 1;        ///< Of the motion: 1 or -1.
  double travel = 0;           ///< rad, since the last reversal or the release.
};

/// The largest angle [rad] and rate [rad/s] of a motion.
struct SwingSize {
  double angle = 0, rate = 0;
};

/// Disturbances of the motion that the fitted law does not have: torques in units of the restoring torque G, and a push
/// at the release.
enum class Disturbance {
  kDry,           ///< s
  kSquare,        ///< s (ω/ω_m)²
  kNarrowStick,   ///< s exp(-(ω / 0.1 ω_m)²)
  kWideStick,     ///< s exp(-(ω / 0.35 ω_m)²)
  kConstant,      ///< 1
  kSlopedDry,     ///< s θ/A
  kCurvedDry,     ///< s (θ/A)²
  kShortBristle,  ///< s exp(-x / 0.05 A), x since the reversal
  kLongBristle,   ///< s exp(-x / 0.2 A)
  kPush,          ///< no torque; a rate of 1 rad/s at the release
};

inline constexpr int kDisturbances = 10;

/// The torques of all disturbances at an instant (MODEL.md section 16).
std::array<double, kDisturbances> TorquesAt(const SwingInstant& instant, const SwingSize& size);

/// The change of angle [rad] and rate [rad/s] at N instants per unit of each disturbance, to first order: N x
/// kDisturbances each.
struct DisturbedMotion {
  Eigen::MatrixXd angle, rate;
};

/// Integrates the equation of motion, linearized about a fitted motion: I δ'' + T_ω δ' + g_θ δ = -τ. At a reversal δ'
/// is multiplied by the ratio of the accelerations after and before it, because dry friction changes its sign there
/// (di Bernardo et al., Piecewise-smooth Dynamical Systems, Springer 2008, section 2.5). The motion between samples is
/// interpolated; the result is accurate to some percent if a period has eight samples or more.
///
/// time       N x 1, s from the first sample, increasing.
/// states     the motion at these instants, without derivatives.
/// begin, end s; before the release and after the stop δ is constant.
/// physical   inertia and friction, in units of the restoring torque G.
DisturbedMotion RespondToDisturbances(const Eigen::VectorXd& time, const MotionStates& states, double begin, double end,
                                      const MotionModel& model, std::span<const double> physical);

}  // namespace pendulum
