// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A turning point of the reading with its errors.
struct Peak {
  double time = 0, value = 0;  ///< s; rad or rad/s, as in the recording
  Eigen::Matrix2d covariance;  ///< 2 x 2, of (time, value)
  bool continues = false;      ///< The previous turning point in the table is also the previous one of the motion.
  Eigen::Index first = 0;      ///< The first of the C samples it was located from.
  Eigen::Matrix2Xd influence;  ///< 2 x C: derivatives of (time, value) with respect to their readings.
};

/// The kink that dry friction causes at a turning point. The reading is displaced by the sticking angle towards where
/// it came from.
struct Kink {
  /// τ_c / G [rad; counts or volts for an uncalibrated angle], and rad/s.
  double sticking_angle = 0, natural_frequency = 0;
};

/// The M turning points of a recording, alternately maxima and minima.
struct PeakTable {
  Quantity quantity = Quantity::kAngle;
  double noise = 0;         ///< rad or rad/s, of a sample about the curves fitted to the turning points
  double half_period = 0;   ///< s, typical
  Estimate zero;            ///< rad or rad/s, of the swing
  Kink kink;                ///< The kink subtracted from the readings.
  std::vector<Peak> peaks;  ///< M >= 3

  double Side(std::size_t peak) const { return peaks[peak].value > zero.value ? 1.0 : -1.0; }
  double Amplitude(std::size_t peak) const { return Side(peak) * (peaks[peak].value - zero.value); }  ///< unit of value

  /// Weights w (M) with zero = Σ w_i value_i: the mean of (e_{i-1} + 2 e_i + e_{i+1}) / 4 over turning points that
  /// follow each other. Dry friction does not change this mean, and a decay hardly changes it.
  Eigen::VectorXd ZeroWeights() const;
};

/// Covariance (K x K, first order) of K numbers computed from turning points. gradient: K x 2 M, derivatives by
/// (time_0, value_0, time_1, ...).
Eigen::MatrixXd CovarianceOf(const PeakTable& table, const Eigen::MatrixXd& gradient);

/// Derivatives (N x K) of these numbers by the N readings of the recording.
Eigen::MatrixXd InfluenceOf(const PeakTable& table, const Eigen::MatrixXd& gradient, Eigen::Index samples);

/// Locates the turning points that FindExtrema finds. Each is located with a polynomial fitted to the readings within a
/// sixth of a period, or a quarter. The degree is 6, or 4 or 2 with few samples. Before the fit the higher terms of a
/// cosine and the kink are subtracted (MODEL.md eq. (6.6)). Errors follow from the noise about all polynomials
/// together. Turning points at an end of the recording or of the sensor's range, or within a gap, are left out.
/// kFailedPrecondition: as FindExtrema, or fewer than three can be located.
Result<PeakTable> LocatePeaks(const Recording& recording, const Kink& kink = {});

}  // namespace pendulum
