// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "pendulum/model/friction/coulomb.h"

namespace pendulum {

inline constexpr ParameterInfo kStiction{
    "stiction", "τ_s", "N m", "1", 0.0, kUnbounded, "dry friction torque at rest, at least coulomb", "static friction"};
inline constexpr ParameterInfo kStribeckRate{"stribeck_rate",
                                             "ω_s",
                                             "rad/s",
                                             "rad/s",
                                             1e-6,
                                             kUnbounded,
                                             "rate scale on which friction falls from stiction to coulomb",
                                             "Stribeck rate"};

/// Viscous friction, and dry friction that increases towards rest:
/// T(ω) = b ω + s (τ_c + (τ_s - τ_c) exp(-(ω/ω_s)²)), τ_s >= τ_c.  MODEL.md eq. (2.7).
struct StribeckFriction {
  static constexpr std::string_view kName = "stribeck";
  static constexpr std::string_view kTitle = "friction with the Stribeck effect";
  static constexpr std::string_view kAbout =
      "Dry friction that is larger at rest than in motion, as in greased bearings that stick before they slide.";
  static constexpr std::array<ParameterInfo, 4> kParameters = {{kViscous, kCoulomb, kStiction, kStribeckRate}};
  static constexpr std::string_view kFormula =
      "{viscous} th' + ({coulomb} + ({stiction} - {coulomb}) exp(-(th'/{stribeck_rate})^2)) sgn(th')";
  static constexpr OrderedPair kOrdered{.larger = 2, .smaller = 1};
  static constexpr std::array kRateScales = {0.03, 0.1, 0.2, 0.4, 0.8};

  template <typename T>
  static T Torque(const T& rate, double direction, const T* p) {
    using std::exp;
    const T share = rate == T(0.0) ? T(1.0) : exp(-(rate / p[3]) * (rate / p[3]));
    return p[0] * rate + direction * (p[1] + (p[2] - p[1]) * share);
  }

  /// Beyond 6 ω_s the dry torque is τ_c to rounding. The torque's series, those of Hermite's polynomials in (ω - ω_0) /
  /// ω_s, then converges quickly from each rate to the next: to order 8 and more it halves from term to term.
  static std::array<double, 4> SpecialRates(const double* p) { return {1.5 * p[3], 3 * p[3], 4.5 * p[3], 6 * p[3]}; }

  /// E = exp(u) with u = -(ω/ω_s)², from n E_n = Σ k u_k E_{n-k}.
  template <typename T>
  struct Recurrence {
    T operator()(int n, const Series<T>& rate, double direction, const T* p) {
      using std::exp;
      if (n == 0) per_square = -1.0 / (p[3] * p[3]);
      exponent[n] = per_square * SquareCoefficient(rate, n);
      share[n] = n == 0 ? exp(exponent[0]) : T(0.0);
      for (int k = 1; k <= n; ++k) share[n] += (static_cast<double>(k) / n) * (exponent[k] * share[n - k]);
      const T dry = (p[2] - p[1]) * share[n];
      return p[0] * rate[n] + direction * (n == 0 ? p[1] + dry : dry);
    }

    T per_square{};
    Series<T> exponent, share;
  };
};

}  // namespace pendulum
