// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/effects/effect.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/solve.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// One way in which a cause changes the readings.
struct Effect {
  Cause cause = Cause::kGain;
  double std_dev = 0;         ///< Plausible size, for a cause of the sensor; 0: any size (a hand, a friction).
  double unseen_std_dev = 0;  ///< For a friction: a size that would not surprise, a share of the whole friction.
};

/// The effects that may act on a recording, and the change of the readings per unit of each: N x E. Units: gain 1; lag
/// s; nonlinearity, backlash, drift and hold in the unit of the readings; push rad/s; friction in units of the
/// restoring torque G. MODEL.md section 16.
struct EffectColumns {
  std::vector<Effect> effects;
  Eigen::MatrixXd columns;
};

/// The effects at a solution, for a sensor that shows the angle, the rate or a point; only the gain for an
/// accelerometer, none for a gyro of unknown scale. A cause of the sensor whose plausible size is 0 and a friction that
/// the law has are not among them, and no push and no friction if two samples are more than a quarter period apart.
/// `at`: increasing indices of two samples or more, which are the rows of the columns. `play`: the width of a play in
/// the unit of the readings, with which its effect grows only nearly in proportion; 0: the plausible one.
EffectColumns EffectColumnsAt(const SensorErrors& sensor, const FitProblem& problem, const TrajectoryCost& cost,
                              const Solution& solution, const std::vector<Eigen::Index>& at, double play = 0);

}  // namespace pendulum
