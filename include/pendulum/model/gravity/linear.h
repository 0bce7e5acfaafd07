// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "pendulum/model/dual.h"
#include "pendulum/model/parameter.h"
#include "pendulum/model/series.h"

namespace pendulum {

/// The torque of a spring or a wire, and gravity in the small-angle model:  g(θ) = θ.  MODEL.md eq. (2.3).
struct LinearGravity {
  static constexpr std::string_view kName = "linear";
  static constexpr std::string_view kTitle = "spring or small angles";
  static constexpr std::string_view kAbout =
      "A Pohl wheel, a torsion wire, a mass on a spring, or the textbook's pendulum at small angles: the period does "
      "not "
      "depend on the angle.";
  static constexpr std::string_view kFormula = "th";
  static constexpr bool kIsLinear = true;
  static constexpr double kTop = kUnbounded;

  static double Torque(double angle) { return angle; }
  static double AngleAtTorque(double torque) { return torque; }
  static double Potential(double angle) { return 0.5 * angle * angle; }
  static double AngleAt(double torque, double /*potential*/) { return torque; }
  static double Chord(double angle) { return angle; }
  static double AngleOfChord(double chord) { return chord; }
  static double PeriodRatio(double /*amplitude*/) { return 1; }

  template <typename T>
  struct Recurrence {
    template <int n>
    [[gnu::always_inline]] double Next(const Series<double>& angle, const Series<double>& /*rate*/) {
      return angle[n];
    }
    template <int n>
    [[gnu::always_inline]] PartialsFor<T> PartialsOf(const Series<PartialsFor<T>>& angle) {
      return angle[n];
    }
  };
};

}  // namespace pendulum
