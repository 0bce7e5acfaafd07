// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/effects/effect.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solve.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A suspicion is named from this significance on, in standard deviations of a normal variable.
inline constexpr double kSuspicious = 5;

/// What the readings were already corrected for, before the fit.
struct Correction {
  std::vector<Cause> causes;
  Eigen::VectorXd sizes;     ///< E, of all effects in the order of EffectColumnsAt; 0 for those of other causes.
  Eigen::VectorXd readings;  ///< N, what these effects add to the readings; empty if there is none.
  double play = 0;           ///< Width of the play among them, in the unit of the readings; 0: none.
};

/// What effects outside the fitted law do to a fit.
struct EffectCheck {
  std::vector<Suspicion> suspicions;  ///< Named causes, the one with the strongest evidence first.
  std::vector<Cause> causes;          ///< E, of the effects.
  Eigen::MatrixXd pull;               ///< P x E, derivatives of the problem's scores with respect to the E effects.
  Eigen::MatrixXd second_moment;      ///< E x E, covariance of their sizes plus the product of their means.
  /// P, the problem's units: how far the estimates would be off, as a standard deviation, if friction had other terms
  /// of 30 % of its size (presliding: all of the dry friction) that the readings do not exclude; empty if nothing is
  /// known of that.
  Eigen::VectorXd unseen_friction;
  /// P, the same units: how far such terms move the estimates beyond the uncertainty of that, the root of the squared
  /// shift less the square of unseen_friction; empty with it.
  Eigen::VectorXd hidden_friction;
  /// P, the problem's units: how far the estimates are off, as a root mean square, by friction that is not in the
  /// law: of what was named, the cause with the strongest evidence; empty if nothing is known of that.
  Eigen::VectorXd named_friction;
  Correction correction;  ///< For the named causes that can be corrected and are plausible, and for former ones.
};

/// The unit in which the size of a cause is given: "1" for the gain, "s" for the lag, "rad/s" for a push, otherwise
/// that of the readings.
std::string UnitOf(Cause cause, const Recording& recording);

/// Estimates all effects (EffectColumnsAt) at an optimum from the residuals, by one step of generalized least squares
/// with the plausible sizes as priors, and tests each cause by its score (MODEL.md section 16). The autocorrelation of
/// what remains is allowed for. `known` is what the fitted readings were corrected for: no suspicion is named for it.
///
/// The second moment is 0 for an effect that has no plausible size and is not suspected. Causes are not tested where
/// the noise is too small against the resolution, and readings that are intervals between fixed levels are not
/// corrected.
EffectCheck CheckEffects(const Recording& recording, const FitProblem& problem, const TrajectoryCost& cost,
                         const Solution& solution, const Optimum& optimum, const Correction& known);

}  // namespace pendulum
