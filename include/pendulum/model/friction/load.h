// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "pendulum/model/friction/viscous.h"

namespace pendulum {

inline constexpr ParameterInfo kLoadFriction{"load_friction",
                                             "τ_l",
                                             "N m",
                                             "1",
                                             0.0,
                                             kUnbounded,
                                             "dry friction torque under the pendulum's weight alone",
                                             "dry friction under the weight"};

/// Viscous friction, and dry friction in proportion to the load of the bearing, which is N times the weight:
/// T = b ω + s τ_l |N|,  N = cos θ + (I_O/G) ω².  MODEL.md eq. (2.11).
struct LoadFriction {
  static constexpr std::string_view kName = "load";
  static constexpr std::string_view kTitle = "viscous friction, and dry friction in proportion to the load";
  static constexpr std::string_view kAbout =
      "A plain bearing rubs more where the pendulum pulls harder: at the bottom of wide, fast swings.";
  static constexpr std::array<ParameterInfo, 2> kParameters = {{kViscous, kLoadFriction}};
  static constexpr std::string_view kFormula = "{viscous} th' + {load_friction} |cos th + (I/G) th'^2| sgn(th')";

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + direction * p[1];
  }

  template <typename T>
  static T LoadTorque(double direction, const T* p) {
    return direction * p[1];
  }

  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      return n == 0 ? p[0] * rate[0] + direction * p[1] : p[0] * rate[n];
    }
  };
};

}  // namespace pendulum
