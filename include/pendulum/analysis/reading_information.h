// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "pendulum/recording/sensor.h"

namespace pendulum {

/// What one reading of a sensor with levels tells of the value x it reads and of the Gaussian noise's standard
/// deviation σ: the Fisher information matrix of (x, log σ), [1 / unit of x^2, 1 / unit of x; 1 / unit of x, 1].
///
/// The levels are those of SensorReading; level k comes with probability p_k = Φ(b_k) - Φ(a_k), a_k and b_k its edges
/// less x over σ, and the information is Σ_k ∇p_k ∇p_kᵀ / p_k, summed exactly. The outermost levels of a range collect
/// what is beyond them, which covers readings that are cut off. Without levels (resolution 0) it is that of a Gaussian
/// reading, [1 / σ^2, 0; 0, 2], and the range must be absent.
///
/// sigma > 0, resolution >= 0. Cost: an erfc for each level within 9 σ.
Eigen::Matrix2d ReadingInformation(double x, double sigma, double resolution, const std::optional<SensorRange>& range);

}  // namespace pendulum
