// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/closed_form/peaks.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Zero, period and friction from the turning points alone. For K friction parameters, units of G; an uncalibrated
/// angle keeps its unit.
struct Decrement {
  MotionModel model;
  PeakTable table;
  Estimate zero;                   ///< rad or rad/s
  Estimate inertia;                ///< s^2
  std::vector<Estimate> friction;  ///< K; may come out negative
  Eigen::MatrixXd covariance;      ///< 2 + K square, of (zero, inertia, friction); rows of parameters left out are 0
  Eigen::MatrixXd gradient;        ///< 2 + K x 2 M: how they follow the M turning points, as for CovarianceOf.
  double chi_square = 0;           ///< Of the times and values of all turning points, with `freedom` degrees.
  int freedom = 0;

  /// Probability of a chi_square as large where the law is right and the errors of the turning points are.
  double Probability() const;
};

/// Fits a model's turning points, exact at any amplitude, to a recording's: weighted least squares of their times and
/// values over the amplitude and the time of the first, the zero, the natural frequency and the friction law (MODEL.md
/// eq. (32), (34)). With viscous and dry friction this is the decrement of B. F. Feeny & J. W. Liang, J. Sound Vib.
/// 195:149 (1996), with drag that of P. T. Squire, Am. J. Phys. 54:984 (1986), each without their small angles, and
/// frictionless the period corrected by the elliptic integral. Errors are those of the turning points, times
/// sqrt(chi_square / freedom) where that is above 1. Turning points are located again once the kinks are known.
/// kFailedPrecondition: as LocatePeaks, or too few for so many unknowns, or no such motion. kTryAgain: a stop was
/// requested before it was done. Cost: some milliseconds, for a thousand turning points a second.
Result<Decrement> FitDecrement(const Recording& recording, const MotionModel& model, const std::stop_token& stop = {});

/// The same from turning points as they were located; friction parameters that are not `included` (K) are 0.
Result<Decrement> FitDecrement(const PeakTable& table, const MotionModel& model, const std::vector<bool>& included,
                               const std::stop_token& stop = {});

/// One term of friction alone, and whether the turning points follow it.
struct EnvelopeLaw {
  std::string term;   ///< A friction parameter of the richest law.
  std::string shape;  ///< Of the amplitudes over time: "exponential", ...
  double chi_square = 0;
  int freedom = 0;
  double probability = 0;  ///< As Decrement::Probability, where the richest law's errors are the true ones.
};

/// What the turning points say of friction laws: those of the richest law's terms alone, and that with all of them.
struct EnvelopeComparison {
  std::vector<EnvelopeLaw> single;
  double richest_chi_square = 0;
  int richest_freedom = 0;
};

/// Which law the envelope follows: dry friction alone a straight line, viscous an exponential, drag a hyperbola. Each
/// is fitted alone; errors are enlarged until all terms together fit. `gravity` as the model's. Errors as FitDecrement.
Result<EnvelopeComparison> CompareEnvelopes(const PeakTable& table, Gravity gravity, const std::stop_token& stop = {});

}  // namespace pendulum
