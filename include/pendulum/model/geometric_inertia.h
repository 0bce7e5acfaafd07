// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/model/rig.h"

namespace pendulum {

/// A moment of inertia that the rig's description gives, beside a fitted one [kg m^2].
struct GeometricInertia {
  bool is_point_mass = false;  ///< (M + m) l², the rod's mass taken to be in the bob.
  double value = 0;
  std::optional<double> std_error;  ///< Absent where the rig file gives no standard deviations.
  /// Standard deviation of value - fitted by the rig's errors alone; both hang on the same masses and lengths.
  double difference_std_error = 0;
};

/// The inertia of the rig, its own or its geometry's, and of a rod and bob the point mass's (MODEL.md eq. (3), (36)).
/// Errors by varying each value of the rig file by its standard deviation, which moves G and so the fitted inertia too.
std::vector<GeometricInertia> GeometricInertias(const Rig& rig, double fitted);

}  // namespace pendulum
