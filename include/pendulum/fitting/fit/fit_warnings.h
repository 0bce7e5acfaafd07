// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pendulum/base/warning.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/solve/fit_problem.h"

namespace pendulum {

/// Warnings about a fit, most with a recommended action. The last four are only for a converged fit:
///
/// saturated: readings at an end of the sensor's range
/// lack_of_fit: autocorrelated residuals that are larger than the noise between neighbouring samples and follow the
/// swing (IsSwingMisfit)
/// correlated_residuals: other autocorrelated residuals
/// zero_drift: the zero of the sensor drifts
/// noise_below_resolution: noise below half the resolution is treated as Gaussian
/// trajectory_accuracy: the trajectory's error is not small compared with the noise
/// prior_conflict: a prior and the recording disagree
/// at_bound: a parameter is at its bound
/// another_minimum: another number of half swings explains the data nearly as well
/// uncertain_stop: the data hardly determine the time of the stop
///
/// described.report: complete except for its warnings.
std::vector<Warning> FitWarnings(const Recording& recording, const FitProblem& problem, const Solution& solution,
                                 const Description& described);

/// Root mean square of N residuals over the noise between neighbouring samples (SuccessiveDifferenceNoise): about 1 if
/// the noise is white. time: s.
double RatioToNeighbourNoise(const Eigen::VectorXd& time, const Eigen::VectorXd& residual);

/// Adds a warning for each suspicion of the report, with the code "suspected_" and the name of the cause: how large it
/// seems to be, whether the estimates allow for it, and what to measure or which flag to set. is_correctable: whether
/// the readings were not corrected although they can be.
void WarnOfSuspicions(bool is_correctable, FitReport& report);

/// What to measure or to set.
std::string_view RemedyFor(Cause cause);

/// The remedy with its flag.
std::string AdviceFor(Cause cause);

/// The flag of the advice, "--calibration"; empty if there is none.
std::string_view FlagFor(Cause cause);

/// "1.0 ± 0.1 %", "0.30 ± 0.02 deg", "5.0 ± 0.3 ms".
std::string SizeText(const Suspicion& suspicion);

/// "1 %", "0.25 deg", "5 ms": a size in the unit 1, s, rad or another.
std::string PlainSizeText(double size, const std::string& unit);

}  // namespace pendulum
