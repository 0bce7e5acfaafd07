// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// Spacing q of the levels offset + q k that a sensor can show: the coarsest one on which the distinct readings lie
/// beyond chance; 0 when they are continuous. In a file printed coarsely it is the sensor's step while the printing
/// step is below about 0.4 q, and the printing step after that. value N x 1, finite, any unit and offset; the result
/// has its unit. More than 20,000 are thinned evenly. Returns 0 as well for fewer than five distinct readings, for a
/// spacing below 1e-6 of their span, for readings too few to come within a few steps of each other, and for a ramp.
double FindResolution(const Eigen::VectorXd& value);

}  // namespace pendulum
