// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// A constant of the rig from K runs that may scatter by more than their errors. Each run has a separate true value,
/// drawn about the rig's value with the standard deviation `between`. All members have the unit of the values.
struct RandomEffects {
  double mean = 0, std_error = 0;
  double lower95 = 0, upper95 = 0;                  ///< Confidence interval of the mean.
  double between = 0;                               ///< Standard deviation between runs; 0: errors explain the scatter.
  double between_lower95 = 0, between_upper95 = 0;  ///< Interval of `between`; NaN: an end is not determined.
};

/// Estimates random effects from values and their standard errors (K >= 2, positive). `between` is computed as by R. C.
/// Paule and J. Mandel, J. Res. NBS 87:377 (1982), and its interval as by W. Viechtbauer, Statistics in Medicine 26:37
/// (2007). The standard error of the mean is computed as by J. Hartung and G. Knapp, Statistics in Medicine 20:3875
/// (2001), but is at least the error of a weighted mean with weights 1 / (std_error² + between²). The interval of the
/// mean uses Student's t with K - 1 degrees of freedom (MODEL.md eq. (10.5) and (10.6)).
RandomEffects SummarizeScatter(const Eigen::VectorXd& value, const Eigen::VectorXd& std_error);

/// Probability that the errors of K >= 2 values alone cause this much scatter (W. G. Cochran, Biometrics 10:101, 1954;
/// MODEL.md eq. (10.3) for one parameter). NaN if a value or an error is not finite, or an error is 0.
double ScatterP(const Eigen::VectorXd& value, const Eigen::VectorXd& std_error);

/// Standard deviation of K >= 2 values about `center`, beyond their errors: as `between`, with `center` instead of the
/// mean. `center` is an average of the values.
double ScatterAbout(double center, const Eigen::VectorXd& value, const Eigen::VectorXd& std_error);

}  // namespace pendulum
