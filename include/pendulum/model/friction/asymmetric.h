// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/model/friction/coulomb.h"

namespace pendulum {

inline constexpr ParameterInfo kAsymmetry{"asymmetry",
                                          "α",
                                          "1",
                                          "1",
                                          -1.0,
                                          1.0,
                                          "share by which dry friction is larger towards positive angles",
                                          "asymmetry of friction"};

/// Viscous friction, and dry friction that depends on the direction, as cables and brushes cause:
/// T(ω) = b ω + s τ_c (1 + s α).  MODEL.md eq. (2.8).
struct AsymmetricFriction {
  static constexpr std::string_view kName = "asymmetric";
  static constexpr std::string_view kTitle = "dry friction that depends on the direction";
  static constexpr std::string_view kAbout =
      "Dry friction that is larger in one direction than in the other, as with cables and brushes.";
  static constexpr std::array<ParameterInfo, 3> kParameters = {{kViscous, kCoulomb, kAsymmetry}};
  static constexpr std::string_view kFormula = "{viscous} th' + {coulomb} (sgn(th') + {asymmetry})";
  static constexpr bool kHasConstantTorque = true;  ///< α τ_c

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + p[1] * (direction + p[2]);
  }

  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      return n == 0 ? p[0] * rate[0] + p[1] * (direction + p[2]) : p[0] * rate[n];
    }
  };
};

}  // namespace pendulum
