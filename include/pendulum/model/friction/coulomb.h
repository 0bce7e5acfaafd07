// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/model/friction/viscous.h"

namespace pendulum {

inline constexpr ParameterInfo kCoulomb{
    "coulomb", "τ_c", "N m", "1", 0.0, kUnbounded, "Coulomb (dry) friction torque", "dry friction"};

/// Viscous and dry friction:  T(ω) = b ω + s τ_c,  s = sign ω.  MODEL.md eq. (2.5).
struct CoulombFriction {
  static constexpr std::string_view kName = "coulomb";
  static constexpr std::string_view kTitle = "viscous and dry friction";
  static constexpr std::string_view kAbout =
      "Dry surfaces rub as well, as in a potentiometer: each swing is smaller by the same angle, and the pendulum "
      "comes to rest.";
  static constexpr std::array<ParameterInfo, 2> kParameters = {{kViscous, kCoulomb}};
  static constexpr std::string_view kFormula = "{viscous} th' + {coulomb} sgn(th')";

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + direction * p[1];
  }

  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      return n == 0 ? p[0] * rate[0] + direction * p[1] : p[0] * rate[n];
    }
  };
};

}  // namespace pendulum
