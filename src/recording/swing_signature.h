// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

/// What the numbers of a column show without a model: whether they swing, with which period and amplitude, and how
/// several columns share one swing. The readers use this to choose columns and units.
namespace pendulum {

/// A swing that was found in a series of readings.
struct SwingSignature {
  double rows_per_period = 0;  ///< Median distance of rising crossings of the middle, in rows.
  double amplitude = 0;        ///< Half of the largest peak-to-peak value, in the unit of the readings.
  bool decays = false;         ///< The last counted amplitude is below 98 % of the largest.
  /// Period at the largest amplitude divided by the period at the smallest counted one; 1 for a linear oscillator.
  double period_ratio = 1;
  double first_amplitude = 0, last_amplitude = 0;  ///< The amplitudes in these two periods.
};

/// Finds a swing: rising crossings of the middle at regular intervals. `values` may contain NaN: rows without a reading
/// count as rows. std::nullopt if the values do not swing. Crossings are counted while the amplitude exceeds a quarter
/// of the largest.
std::optional<SwingSignature> FindSwingSignature(const Eigen::VectorXd& values);

/// Covariance of the columns of a table in the band of a swing, K x K in the squared unit of the readings. Constants,
/// drifts, even harmonics and fast vibrations do not count: each column is averaged over a sixth of a period, and a
/// reading half a period earlier is subtracted. `columns` are of equal length and may contain NaN.
Eigen::MatrixXd SwingCovariance(const std::vector<Eigen::VectorXd>& columns, double rows_per_period);

/// Period of a pendulum at this amplitude [rad] divided by that of small swings, 1 / AGM(1, cos(A/2)).
double PendulumPeriodRatio(double amplitude);

}  // namespace pendulum
