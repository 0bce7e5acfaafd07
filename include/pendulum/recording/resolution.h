// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// Spacing q of the levels offset + q k that a sensor can show. It is the coarsest spacing on which the distinct
/// readings lie beyond chance; 0 if they are continuous. In a file printed with few digits it is the sensor's step as
/// long as the printing step is below about 0.4 q, otherwise the printing step. value: N x 1, finite, any unit and
/// offset; the result has its unit. More than 20,000 readings are thinned evenly. Also returns 0 if there are
/// fewer than five distinct readings, if the spacing is below 1e-6 of their span, if too few readings lie within a few
/// steps of each other, and for a ramp.
double FindResolution(const Eigen::VectorXd& value);

}  // namespace pendulum
