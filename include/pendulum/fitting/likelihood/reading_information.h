// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "pendulum/recording/sensor.h"

namespace pendulum {

/// Fisher information of (x, log σ) in one reading of a value x with Gaussian noise, on the levels of SensorReading.
/// Units: [1 / unit of x^2, 1 / unit of x; 1 / unit of x, 1]. The outermost levels of a range include everything beyond
/// them. Without levels (resolution 0) it is [1 / σ^2, 0; 0, 2], and the range must be absent. sigma > 0, resolution >=
/// 0. Cost: one erfc per level within 9 σ.
Eigen::Matrix2d ReadingInformation(double x, double sigma, double resolution, const std::optional<SensorRange>& range);

}  // namespace pendulum
