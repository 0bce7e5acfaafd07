// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/model/friction/coulomb.h"

namespace pendulum {

inline constexpr ParameterInfo kDrag{
    "drag", "c", "N m s^2/rad^2", "s^2", 0.0, kUnbounded, "quadratic (air) drag coefficient", "air drag"};

/// Viscous friction, dry friction and air drag:  T(ω) = b ω + s (τ_c + c ω²),  s = sign ω.  MODEL.md eq. (2.6).
struct DragFriction {
  static constexpr std::string_view kName = "drag";
  static constexpr std::string_view kTitle = "viscous and dry friction, and air drag";
  static constexpr std::string_view kAbout =
      "Air drag acts as well; it grows with the square of speed and is visible in wide swings.";
  static constexpr std::array<ParameterInfo, 3> kParameters = {{kViscous, kCoulomb, kDrag}};
  static constexpr std::string_view kFormula = "{viscous} th' + {coulomb} sgn(th') + {drag} th' |th'|";

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + direction * (p[1] + p[2] * rate * rate);
  }

  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      const T smooth = p[0] * rate[n] + (direction * p[2]) * SquareCoefficient(rate, n);
      return n == 0 ? smooth + direction * p[1] : smooth;
    }
  };
};

}  // namespace pendulum
