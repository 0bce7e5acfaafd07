// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace pendulum {

/// Spacing q of the levels offset + q k that a sensor can show, found from its readings; 0 when they are continuous.
///
/// The coarsest q for which the distinct readings lie on levels beyond chance, by least squares over all of them: their
/// distance to the levels, as a normal density against a uniform one, is a likelihood ratio above e^16, and its root
/// mean square below 0.12 q. Where a file was printed coarsely it is the sensor's step while the printing step is below
/// about 0.4 q, and the printing step after that. Where readings halfway between the levels are more than one in twenty
/// of the distinct ones (averages of two readings) it is the finer spacing, else the sensor's own.
///
/// value   N x 1, finite, any unit and offset; the result has its unit. More than 20,000 are thinned evenly.
/// Returns 0 as well for fewer than five distinct readings, for a spacing below 1e-6 of their span, for readings too
/// few to come within a few steps of each other, and for a ramp, whose readings are evenly spaced and never repeat.
double FindResolution(const Eigen::VectorXd& value);

}  // namespace pendulum
