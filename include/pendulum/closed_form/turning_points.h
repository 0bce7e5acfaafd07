// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// A turning point of the reading. LocateTurningPoints sets covariance, first and influence.
struct TurningPoint {
  double time = 0, value = 0;  ///< s; unit of the recording's values
  Eigen::Index sample = 0;     ///< The largest or smallest sample.
  bool continues = false;      ///< The previous turning point in the table is also the previous one of the motion.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< 2 x 2, of (time, value)
  Eigen::Index first = 0;                                ///< The first of the C samples it was located from.
  Eigen::Matrix2Xd influence = {};  ///< 2 x C: derivatives of (time, value) with respect to the C readings.
};

/// Turning points [first, last] that follow each other: last - first half swings without a gap.
struct TurningPointRun {
  std::size_t first = 0, last = 0;
};

/// The kink that dry friction causes at a turning point. The centre of the swing is displaced by the sticking angle
/// against the direction of motion, which changes at the turning point.
struct Kink {
  /// τ_c / G [rad; counts or volts for an uncalibrated angle], and rad/s.
  double sticking_angle = 0, natural_frequency = 0;
};

/// The M turning points of a recording, alternately maxima and minima, in time order. Values, noise, zeros and
/// amplitudes have the unit of the recording's values.
struct TurningPointTable {
  Quantity quantity = Quantity::kAngle;
  bool is_calibrated = true;       ///< As the recording.
  double resolution = 0;           ///< As the recording.
  double noise = 0;                ///< Standard deviation of the noise of a sample.
  double threshold = 0;            ///< The least height of a turning point.
  double half_period = 0;          ///< s, typical
  Estimate zero;                   ///< Of the whole swing.
  std::vector<double> local_zero;  ///< M: the zero near each turning point, if it may drift; empty: `zero`.
  Kink kink;                       ///< The kink that was subtracted from the readings.
  std::vector<TurningPoint> points;

  std::size_t half_swings() const { return points.empty() ? 0 : points.size() - 1; }

  double ZeroAt(std::size_t point) const { return local_zero.empty() ? zero.value : local_zero[point]; }

  /// 1 above the zero, otherwise -1.
  double Side(std::size_t point) const { return points[point].value > ZeroAt(point) ? 1.0 : -1.0; }

  double Amplitude(std::size_t point) const { return std::abs(points[point].value - ZeroAt(point)); }

  std::vector<double> Amplitudes() const;  ///< M

  /// Duration of a half swing from this turning point, divided by that of a small swing (MODEL.md eq. (6.1)).
  double Stretch(std::size_t point) const;

  /// How far a reading may differ from the value of this turning point and still count as equal: 5 % of the amplitude
  /// plus three standard deviations of the noise and two resolutions.
  double Tolerance(std::size_t point) const;

  /// The runs of at least two turning points that `continues` joins.
  std::vector<TurningPointRun> Runs() const;

  /// The largest amplitude in the runs; 0 without a run.
  double LargestAmplitude() const;

  /// Weights w (M) with Σ w_i value_i = mean of (e_{i-1} + 2 e_i + e_{i+1}) / 4 over turning points that follow each
  /// other. Dry friction does not change this mean, and a decay hardly changes it.
  Eigen::VectorXd ZeroWeights() const;
};

/// Standard deviation of the noise [unit of the recording], from each sample's distance to the line through its
/// neighbours. Curvature between samples counts as noise; quantized data may give 0.
double SuccessiveDifferenceNoise(const Recording& recording);

/// Turning points located to O(h³) instead of to one sampling interval h. A turning point counts once the reading has
/// moved back by more than the threshold: the maximum of 2 sqrt(2 ln N) + 1 standard deviations of the noise between
/// neighbours, two resolutions, and 3 % of the range (of an angle's range at most one turn counts). A hold, or a start
/// in the middle of a swing, is not a turning point. The zero is the median of (e_{i-1} + 2 e_i + e_{i+1}) / 4. A
/// turning point does not continue the motion if it lies on the same side of the zero as the previous one, or after a
/// gap in the data longer than 0.6 half periods. kFailedPrecondition: fewer than three; the message gives their number.
Result<TurningPointTable> FindTurningPoints(const Recording& recording);

/// The same turning points for ClassifyHalfSwings, which does not assume a free swing. The first entry is only a
/// candidate: it may be the start of the recording or lie in a hold. There may be fewer than three entries. With three
/// or more, local zeros and the half period of small swings are set. `continues` is never set.
TurningPointTable FindAllTurningPoints(const Recording& recording);

/// Whether the readings may be the maxima of a swing on one side: few of them, and nearly all are smaller than the one
/// before. Those of a hold are not.
bool AreMaxima(const Recording& recording);

}  // namespace pendulum
