// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pendulum/model/rig.h"

namespace pendulum {

/// A moment of inertia that follows from the rig's description, to compare with the fitted one [kg m^2].
struct GeometricInertia {
  bool is_point_mass = false;  ///< True for (M + m) l²: the rod's mass counts as part of the bob.
  double value = 0;
  std::optional<double> std_error;  ///< std::nullopt if all of the rig's are 0.
  /// Standard deviation of (value - fitted) due to the rig's errors alone. Both depend on the same masses and lengths.
  double difference_std_error = 0;
};

/// The inertia of the rig, given or computed from its geometry. For a rod and bob also the inertia of the point mass
/// (MODEL.md eq. (1.3), (6.10)). The standard errors come from varying each value of the rig file by its standard
/// deviation. Each variation also changes G and therefore the fitted inertia.
std::vector<GeometricInertia> GeometricInertias(const Rig& rig, double fitted);

}  // namespace pendulum
