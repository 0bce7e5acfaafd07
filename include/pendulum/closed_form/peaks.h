// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A turning point of the reading, located with its errors.
struct Peak {
  double time = 0, value = 0;  ///< s; rad or rad/s, as the recording
  Eigen::Matrix2d covariance;  ///< 2 x 2, of (time, value)
  bool continues = false;      ///< The turning point before it in the table is the one before it in the motion.
  Eigen::Index first = 0;      ///< The first of the C samples it was found on.
  Eigen::Matrix2Xd influence;  ///< 2 x C: derivatives of (time, value) with respect to their readings.
};

/// The kink of dry friction at a turning point: the reading is displaced by the sticking angle to where it came from.
struct Kink {
  /// τ_c / G [rad; counts or volts of an uncalibrated angle], and rad/s.
  double sticking_angle = 0, natural_frequency = 0;
};

/// The turning points of a recording, maxima and minima in turn. For M of them.
struct PeakTable {
  Quantity quantity = Quantity::kAngle;
  double noise = 0;         ///< rad or rad/s, of a sample about the curves that the peaks were found on
  double half_period = 0;   ///< s, typical
  Estimate zero;            ///< rad or rad/s, of the swing
  Kink kink;                ///< That was taken out of the readings.
  std::vector<Peak> peaks;  ///< M >= 3

  double Side(std::size_t peak) const { return peaks[peak].value > zero.value ? 1.0 : -1.0; }
  double Amplitude(std::size_t peak) const { return Side(peak) * (peaks[peak].value - zero.value); }  ///< as value

  /// w (M) with zero = Σ w_i value_i: the mean of (e_{i-1} + 2 e_i + e_{i+1}) / 4 over turning points that follow each
  /// other, to which dry friction adds nothing and a decay next to nothing.
  Eigen::VectorXd ZeroWeights() const;
};

/// Covariance of K numbers from turning points (K x K, first order); gradient K x 2 M by (time_0, value_0, time_1,
/// ...).
Eigen::MatrixXd CovarianceOf(const PeakTable& table, const Eigen::MatrixXd& gradient);

/// Derivatives (N x K) of such numbers with respect to the N readings of the recording.
Eigen::MatrixXd InfluenceOf(const PeakTable& table, const Eigen::MatrixXd& gradient, Eigen::Index samples);

/// Locates the turning points that FindExtrema sees, each by a polynomial fitted to the readings within a sixth of a
/// period of it, or a quarter: of degree 6, or 4 and 2 where there are few samples, of what the readings are beside
/// a cosine's higher terms and the kink (MODEL.md eq. (33)). Errors from the noise about all polynomials together. A
/// turning point at an end of the recording or of the sensor's range, or amid a gap, is left out.
/// kFailedPrecondition: as FindExtrema, or fewer than three of them can be located.
Result<PeakTable> LocatePeaks(const Recording& recording, const Kink& kink = {});

}  // namespace pendulum
