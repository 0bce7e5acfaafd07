// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pendulum/model/friction/drag.h"

namespace pendulum {

/// Viscous friction and air drag without dry friction:  T(ω) = b ω + c ω |ω|. Written by the recipe of CONTRIBUTING.md.
struct WindFriction {
  static constexpr std::string_view kName = "wind";
  static constexpr std::string_view kTitle = "viscous friction and air drag";
  static constexpr std::string_view kAbout = "For a pendulum whose axis has no dry friction, as on a thread.";
  static constexpr std::array<ParameterInfo, 2> kParameters = {{kViscous, kDrag}};
  static constexpr std::string_view kFormula = "{viscous} th' + {drag} th' |th'|";

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + direction * p[1] * rate * rate;
  }

  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      return p[0] * rate[n] + (direction * p[1]) * SquareCoefficient(rate, n);
    }
  };
};

}  // namespace pendulum
