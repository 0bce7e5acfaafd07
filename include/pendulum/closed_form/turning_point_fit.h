// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Zero, period and K friction parameters from the turning points alone, in units of the restoring torque G. An
/// uncalibrated angle keeps its unit.
struct TurningPointFit {
  MotionModel model;
  TurningPointTable table;
  Estimate zero;                   ///< rad or rad/s
  Estimate inertia;                ///< s^2
  std::vector<Estimate> friction;  ///< K; may be negative
  Eigen::MatrixXd covariance;      ///< (2 + K) x (2 + K), of (zero, inertia, friction); 0 for parameters left out
  Eigen::MatrixXd gradient;        ///< (2 + K) x 2 M, with respect to the M turning points, as for CovarianceOf.
  double chi_square = 0;           ///< Of all turning points' times and values, `freedom` degrees of freedom.
  int freedom = 0;

  /// Probability of a chi_square at least as large if the law and the errors of the turning points are right.
  double Probability() const;
};

/// Fits the turning points of a model, exact at any amplitude, to the turning points of a recording: weighted least
/// squares of their times and values. The unknowns are the amplitude and the time of the first turning point of each
/// run, the zero, the natural frequency and the friction parameters (MODEL.md eq. (6.5), (6.7)). With viscous and dry
/// friction this is the decrement of B. F. Feeny & J. W. Liang, J. Sound Vib. 195:149 (1996), with drag the decrement
/// of P. T. Squire, Am. J. Phys. 54:984 (1986), but without their small-angle approximation. Without friction it is the
/// period corrected by the elliptic integral. Errors follow from the errors of the turning points, multiplied by
/// sqrt(chi_square / freedom) if this factor is above 1. Once the kinks are known, the turning points are located
/// again. kFailedPrecondition: as LocateTurningPoints, a law that is not linear in its parameters, too few turning
/// points for the number of unknowns, or no convergence. kTryAgain: a stop was requested before the end. Cost: some
/// milliseconds; a second for a thousand turning points.
Result<TurningPointFit> FitTurningPoints(const Recording& recording, const MotionModel& model,
                                         const std::stop_token& stop = {});

/// The same fit to turning points that are already located. Friction parameters that are not `included` (K) are 0.
Result<TurningPointFit> FitTurningPoints(const TurningPointTable& table, const MotionModel& model,
                                         const std::vector<bool>& included, const std::stop_token& stop = {});

/// The fit of one friction term alone to the turning points.
struct EnvelopeLaw {
  std::string term;   ///< A friction parameter of the richest law.
  std::string shape;  ///< How the amplitudes depend on time: "exponential", ...
  double chi_square = 0;
  int freedom = 0;
  double probability = 0;  ///< As TurningPointFit::Probability, with the errors enlarged until the richest law fits.
};

/// Fits of friction laws to the turning points: each term of the richest law alone, and all terms together.
struct EnvelopeComparison {
  std::vector<EnvelopeLaw> single;
  double richest_chi_square = 0;
  int richest_freedom = 0;
};

/// Compares which law the envelope follows: a straight line for dry friction alone, an exponential for viscous
/// friction, a hyperbola for drag. Each is fitted alone. The errors are enlarged until all terms together fit.
/// `gravity` is the model's. Errors as FitTurningPoints.
Result<EnvelopeComparison> CompareEnvelopes(const TurningPointTable& table, Gravity gravity,
                                            const std::stop_token& stop = {});

}  // namespace pendulum
