// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "pendulum/model/parameter.h"
#include "pendulum/model/series.h"

namespace pendulum {

inline constexpr ParameterInfo kViscous{
    "viscous", "b", "N m s/rad", "s", 0.0, kUnbounded, "viscous friction coefficient", "viscous friction"};

/// Viscous friction alone:  T(ω) = b ω.  MODEL.md eq. (2.4).
struct ViscousFriction {
  static constexpr std::string_view kName = "viscous";
  static constexpr std::string_view kTitle = "viscous friction";
  static constexpr std::string_view kAbout =
      "Friction grows with speed, as in oil or a good bearing: each swing is smaller by the same share.";
  static constexpr std::array<ParameterInfo, 1> kParameters = {{kViscous}};
  static constexpr std::string_view kFormula = "{viscous} th'";

  template <typename T>
  static T Torque(const T& rate, double /*direction*/, const T* p) {
    return p[0] * rate;
  }

  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double /*direction*/, const T* p) { return p[0] * rate[n]; }
  };
};

}  // namespace pendulum
