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

/// F test of the highest power of a curve. It compares the curve with the curve without this power, MODEL.md eq. (8.3).
struct OrderTest {
  int order;    ///< Order of the curve with the power.
  double f;     ///< F, with 1 and `freedom` degrees of freedom; infinite if the curve passes through every point.
  int freedom;  ///< N - order - 1.
  double p;     ///< Probability of so large an F if the power were absent.
};

/// Tests whether rounding to whole counts alone explains the residuals, MODEL.md eq. (8.3).
struct RoundingTest {
  double std_dev;  ///< Of the residuals caused by rounding alone, resolution / √12, angle_unit.
  double p;        ///< Probability of residuals at least as large by rounding alone, χ².
};

/// A curve through a table, and the quality of the fit. The N residuals are in the table's order and its angle_unit.
struct CalibrationFit {
  Calibration calibration;  ///< With all its keys in `source`; covariance 0 x 0 if N = order + 1.
  int order = 1;
  Eigen::VectorXd residual;               ///< N x 1, angle - curve.
  Eigen::VectorXd left_out;               ///< N x 1, angle - curve fitted without this point; 0 x 1 if N = order + 1.
  Eigen::Index largest = 0;               ///< Point of the largest residual.
  double resolution = 0;                  ///< Angle of one count, rms over the points, angle_unit; 0 for volts.
  std::optional<RoundingTest> rounding;   ///< For counts, unless N = order + 1.
  std::optional<OrderTest> lower_order;   ///< Compares this curve with the next lower order; std::nullopt for a line.
  std::optional<OrderTest> higher_order;  ///< Compares the next higher order with this curve; std::nullopt if untested.

  /// Root mean square of left_out, angle_unit; std::nullopt if N = order + 1.
  std::optional<double> LeaveOneOutRms() const;
};

/// Least squares of angle on reading, MODEL.md eqs. (8.1) and (8.2): a polynomial of the given order. The covariance of
/// its coefficients is σ̂² (XᵀX)⁻¹ with σ̂² = RSS / (N - order - 1). Residuals are assumed to be independent and equally
/// large. Readings are centred and scaled, so no digits are lost at orders up to 5; the coefficients are those of
/// powers of the reading. `input_range` is the range that the sensor can show. kInvalidArgument: an order not in 1 to
/// kHighestCalibrationOrder, or a reading outside input_range. kDataLoss: fewer points than coefficients, a curve that
/// turns between the points, or readings too far apart or too similar for the order.
Result<CalibrationFit> CalibrateSensor(const CalibrationTable& table, int order,
                                       const std::optional<SensorRange>& input_range = std::nullopt);

/// JSON that ParseCalibration reads: every key, unrounded. Missing covariance, residual_std_dev and input_range are
/// null.
nlohmann::ordered_json CalibrationJson(const Calibration& calibration);

/// The first of 1001 readings from low to high at which the curve runs against its overall direction, so that two
/// readings show one angle. std::nullopt: the curve rises or falls throughout.
std::optional<double> FindTurningReading(const Calibration& calibration, double low, double high);

}  // namespace pendulum
