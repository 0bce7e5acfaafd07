// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "pendulum/base/status.h"
#include "pendulum/recording/calibration/calibration_table.h"
#include "pendulum/recording/sensor.h"

namespace pendulum {

inline constexpr int kHighestCalibrationOrder = 5;

/// Does the highest power of a curve earn its place? F test of the curve against the one without it, MODEL.md eq. (42).
struct OrderTest {
  int order;    ///< Of the curve with the power.
  double f;     ///< F, with 1 and `freedom` degrees of freedom; infinite when the curve passes through every point.
  int freedom;  ///< N - order - 1.
  double p;     ///< Probability of such an F if the power were not there.
};

/// Are the residuals no larger than what rounding to whole counts makes them? MODEL.md eq. (42).
struct RoundingTest {
  double std_dev;  ///< Of the residuals that rounding alone would leave, resolution / √12, angle_unit.
  double p;        ///< Probability of residuals as large or larger by rounding alone, χ².
};

/// A curve through a table, and how well it fits. The N residuals are in the order of the table, in its angle_unit.
struct CalibrationFit {
  Calibration calibration;  ///< With all its keys in `source`; covariance 0 x 0 when N = order + 1.
  int order = 1;
  Eigen::VectorXd residual, left_out;     ///< N x 1: angle - curve; - curve without that point, 0 x 1 if N = order + 1.
  Eigen::Index largest = 0;               ///< Point of the largest residual.
  double resolution = 0;                  ///< Angle of one count, rms over the points, angle_unit; 0 for volts.
  std::optional<RoundingTest> rounding;   ///< Of counts, unless N = order + 1.
  std::optional<OrderTest> lower_order;   ///< Of this curve against one of lower order; none for a straight line.
  std::optional<OrderTest> higher_order;  ///< Of one higher order; none with too few points or for the highest.

  /// Root mean square of left_out, angle_unit; none if N = order + 1.
  std::optional<double> LeaveOneOutRms() const;
};

/// Least squares of angle on reading, MODEL.md eqs. (40) and (41): a polynomial of that order with the covariance of
/// its coefficients σ̂² (XᵀX)⁻¹, σ̂² = RSS / (N - order - 1). Residuals count as independent and of one size. Centred
/// and scaled readings lose no digits at orders up to 5; the coefficients are those of powers of the reading itself.
/// `input_range` is what the sensor can show. kInvalidArgument: an order not in 1 to kHighestCalibrationOrder, a
/// reading outside input_range. kDataLoss: fewer points than coefficients, a curve that turns between the points,
/// readings too far apart or too alike for the order.
Result<CalibrationFit> CalibrateSensor(const CalibrationTable& table, int order,
                                       const std::optional<SensorRange>& input_range = std::nullopt);

/// As ParseCalibration reads it: every key, unrounded; absent covariance, residual_std_dev and input_range are null.
nlohmann::ordered_json CalibrationJson(const Calibration& calibration);

/// The first of 1001 readings from low to high where the curve does not go the way it goes as a whole from low to high:
/// there two readings show one angle. None: it rises or falls throughout.
std::optional<double> TurningReading(const Calibration& calibration, double low, double high);

}  // namespace pendulum
