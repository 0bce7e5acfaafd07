// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "pendulum/model/friction/coulomb.h"

namespace pendulum {

/// The lower bound keeps the oscillation of a pendulum that hangs on its bristles slow enough to trace.
inline constexpr ParameterInfo kPreslidingAngle{"presliding_angle",
                                                "θ_p",
                                                "rad",
                                                "rad",
                                                1e-4,
                                                kUnbounded,
                                                "angle over which dry friction builds up after a reversal",
                                                "presliding angle"};

/// Viscous friction, and dry friction that builds up over an angle after each reversal, as bristles that bend before
/// they slide:  T = b ω + τ_c u,  u' = (ω - |ω| u) / θ_p.  MODEL.md eq. (2.10). P. R. Dahl, "A solid friction model",
/// Aerospace Corporation TOR-158(3107-18), 1968, with exponent 1; u is the deflection of the bristles as a share of
/// that at which they slide. For θ_p -> 0 it is the law coulomb.
struct DahlFriction {
  static constexpr std::string_view kName = "dahl";
  static constexpr std::string_view kTitle = "viscous friction, and dry friction with presliding";
  static constexpr std::string_view kAbout =
      "Dry friction that yields like a spring before it slides, as in ball bearings, cables and rubber.";
  static constexpr std::array<ParameterInfo, 3> kParameters = {{kViscous, kCoulomb, kPreslidingAngle}};
  static constexpr std::string_view kFormula = "{viscous} th' + {coulomb} u, u' = (th' - |th'| u) / {presliding_angle}";
  static constexpr std::array kAngleScales = {0.03, 0.005, 0.15};
  static constexpr int kStates = 1;

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    return p[0] * rate + direction * p[1];
  }

  static double TorqueAt(const std::array<double, 1>& u, const double* p) { return p[1] * u[0]; }

  static constexpr std::array<double, 1> SlidingStates(double direction) { return {direction}; }

  /// The slope of the torque at a reversal from sliding, where bristles unbend as fast as they then bend.
  static double Stiffness(const double* p) { return 2 * p[1] / p[2]; }

  /// (n + 1) u_{n+1} = (ω_n - s Σ ω_k u_{n-k}) / θ_p.
  template <typename T>
  class Recurrence {
   public:
    void Begin(const std::array<T, 1>& u) { u_[0] = u[0]; }

    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      if (n == 0) {
        per_angle_ = 1.0 / p[2];
        direction_ = direction;
      }
      if (n < kMaxOrder)
        u_[n + 1] = (kInverse[n + 1] * per_angle_) * (rate[n] - direction * CauchyProduct(rate, u_, n));
      return p[0] * rate[n] + p[1] * u_[n];
    }

    /// u as a function of the angle, because du/dθ = (1 - s u) / θ_p. Unlike the series it is exact however small τ_c
    /// is, which hides u from the control of the step. Once the bristles slide, u is the direction: derivatives of what
    /// is left to it would grow in a long step, whose length only the values limit.
    std::array<T, 1> StatesAfter(const T& travel) const {
      using std::exp;
      constexpr double kSlides = 1e-12;
      const T u = direction_ + (u_[0] - direction_) * exp(-direction_ * travel * per_angle_);
      return {std::abs(Value(u) - direction_) < kSlides ? T(direction_) : u};
    }

   private:
    T per_angle_{};
    double direction_ = 1;
    Series<T> u_{};
  };
};

}  // namespace pendulum
