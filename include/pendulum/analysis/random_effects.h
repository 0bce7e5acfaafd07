// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// A rig's constant from K runs that may scatter by more than their own errors: each run has a value of its own, drawn
/// about the rig's with the standard deviation `between`. Unit of the values.
struct RandomEffects {
  double mean = 0, std_error = 0;
  double lower95 = 0, upper95 = 0;                  ///< Of the mean.
  double between = 0;                               ///< Standard deviation between runs; 0: errors explain all.
  double between_lower95 = 0, between_upper95 = 0;  ///< Of `between`; NaN: values lie too close to tell an end.
};

/// From values and their standard errors (K >= 2, positive): `between` of R. C. Paule and J. Mandel, J. Res. NBS 87:377
/// (1982), its interval of W. Viechtbauer, Statistics in Medicine 26:37 (2007), the mean's error of J. Hartung and G.
/// Knapp, Statistics in Medicine 20:3875 (2001), never below that of runs that agree, with Student's t of K - 1 degrees
/// of freedom (MODEL.md eq. (60) and (61)).
RandomEffects SummarizeScatter(const Eigen::VectorXd& value, const Eigen::VectorXd& std_error);

/// Probability that K >= 2 values scatter by as much through their errors alone (W. G. Cochran, Biometrics 10:101,
/// 1954; MODEL.md eq. (58) for one parameter); NaN where a value or an error is no number, or an error 0.
double ScatterP(const Eigen::VectorXd& value, const Eigen::VectorXd& std_error);

/// The standard deviation about `center`, beyond their errors, of K >= 2 values that it is an average of: as `between`,
/// with `center` in the mean's place.
double ScatterAbout(double center, const Eigen::VectorXd& value, const Eigen::VectorXd& std_error);

}  // namespace pendulum
