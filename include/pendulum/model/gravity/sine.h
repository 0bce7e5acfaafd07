// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "pendulum/base/physics.h"
#include "pendulum/model/dual.h"
#include "pendulum/model/series.h"

namespace pendulum {

/// Coefficients of sin θ and cos θ along a trajectory, in order of n, by the coupled recurrence
/// n sin_n = Σ ω_k cos_{n-1-k}, n cos_n = -Σ ω_k sin_{n-1-k} with ω = θ' (MODEL.md eq. (4.3)). For speed, one quad
/// holds the sums for sine and cosine of two successive coefficients. The sums run from the middle outwards: the latest
/// coefficients are added last, so only the last additions wait for them.
class SineSeries {
 public:
  /// Coefficient n of the sine, from θ_0 and coefficients 0..n-1 of ω. Call with n = 0, 1, 2, ... in this order.
  template <int n>
  [[gnu::always_inline]] double Next(double angle, const Series<double>& rate) {
    if constexpr (n == 0) {
      return Set<n>(std::sin(angle), std::cos(angle));
    } else {
      Sums sums = InnerSums<n>(rate);
      constexpr int kMiddle = kInPairs<n> ? kOuter : (n - 1) / 2;
      constexpr bool kAlone = kInPairs<n> == (n % 2 == 0);
      if constexpr (kAlone && kMiddle > 0) Add(rate[kMiddle], n - 1 - kMiddle, sums);
#pragma GCC unroll 32
      for (int k = kMiddle - (kAlone ? 1 : 0); k > 0; --k) {
        Add(rate[n - 1 - k], k, sums);
        Add(rate[k], n - 1 - k, sums);
      }
      if constexpr (n > 1) Add(rate[n - 1], 0, sums);
      const double first = rate[0] * kInverse[n];
      return Set<n>(sums.sine * kInverse[n] + first * cosine_[n - 1],
                    sums.cosine * -kInverse[n] - first * sine_[n - 1]);
    }
  }

  /// Partial derivatives of coefficient n from those of coefficients 0..n of θ. Next<n> must have been called. Using
  /// d sin θ = cos θ dθ (MODEL.md eq. (4.4)) costs one product of series per parameter; the recurrence in dual numbers
  /// costs four. For even n, `next` receives the part of coefficient n + 1 that can be computed already.
  template <int n, int P>
  [[gnu::always_inline]] Partials<P> PartialsOf(const Series<Partials<P>>& angle, Partials<P>& next) const {
    if constexpr (n % 2 == 1) {
      Partials<P> sum = next;
      sum.AddProduct(spread_cosine_[0], angle[n]);
      sum.AddProduct(spread_cosine_[n], angle[0]);
      return sum;
    } else {
      constexpr int kMiddle = n / 2;
      Partials<P> sum;
      next = {};
      sum.AddProduct(spread_cosine_[kMiddle], angle[kMiddle]);
      if constexpr (n > 0) next.AddProduct(spread_cosine_[kMiddle], angle[kMiddle + 1]);
#pragma GCC unroll 32
      for (int k = kMiddle - 1; k >= 0; --k) {
        sum.AddProduct(spread_cosine_[n - k], angle[k]);
        next.AddProduct(spread_cosine_[n - k], angle[k + 1]);
        sum.AddProduct(spread_cosine_[k], angle[n - k]);
        if (k > 0) next.AddProduct(spread_cosine_[k], angle[n + 1 - k]);
      }
      return sum;
    }
  }

 private:
  /// Terms k <= kOuter and the opposite terms n - 1 - k are added one by one, because they become known late.
  static constexpr int kOuter = 1;
  template <int n>
  static constexpr bool kInPairs = n > 2 * kOuter + 1;

  /// Partial sums of n sin_n and -n cos_n.
  struct Sums {
    double sine = 0, cosine = 0;
  };

  /// Sums of the inner terms of coefficient n; for even n also those of coefficient n + 1.
  template <int n>
  [[gnu::always_inline]] Sums InnerSums(const Series<double>& rate) {
    if constexpr (!kInPairs<n>) {
      return {};
    } else if constexpr (n % 2 == 1) {
      return next_;
    } else {
      constexpr int kMiddle = n / 2;
      Quad low = rate[kMiddle] * pair_[n - 1 - kMiddle];
      Quad high{};
#pragma GCC unroll 32
      for (int k = kMiddle - 1; k > kOuter; --k) {
        high += rate[n - k] * pair_[k - 1];
        low += rate[k] * pair_[n - 1 - k];
      }
      low += high;
      next_ = {low[2], low[3]};
      return {low[0], low[1]};
    }
  }

  [[gnu::always_inline]] void Add(double rate, int n, Sums& sums) const {
    sums.sine += rate * cosine_[n];
    sums.cosine += rate * sine_[n];
  }

  template <int n>
  [[gnu::always_inline]] double Set(double sine, double cosine) {
    sine_[n] = sine;
    cosine_[n] = cosine;
    spread_cosine_[n] = Quad{cosine, cosine, cosine, cosine};
    if constexpr (n > 0) pair_[n - 1] = Quad{cosine_[n - 1], sine_[n - 1], cosine, sine};
    return sine;
  }

  Series<double> sine_{};
  Series<double> cosine_{};
  alignas(kQuadAlignment) Series<Quad> spread_cosine_{};  ///< cos_n in all four lanes.
  alignas(kQuadAlignment) Series<Quad> pair_{};           ///< cos_n, sin_n, cos_{n+1}, sin_{n+1}
  Sums next_;
};

/// The gravity of a pendulum:  g(θ) = sin θ.  MODEL.md eq. (2.2).
struct SineGravity {
  static constexpr std::string_view kName = "sin";
  static constexpr std::string_view kTitle = "any angle";
  static constexpr std::string_view kAbout = "A rigid body that swings about a fixed axis.";
  static constexpr std::string_view kFormula = "sin th";
  static constexpr bool kIsLinear = false;
  static constexpr double kTop = kPi;

  static double Torque(double angle) { return std::sin(angle); }
  static double AngleAtTorque(double torque) { return std::asin(torque); }
  static double Potential(double angle) { return 1 - std::cos(angle); }
  static double AngleAt(double torque, double potential) { return std::atan2(torque, 1 - potential); }
  static double Chord(double angle) { return 2 * std::sin(0.5 * angle); }
  static double AngleOfChord(double chord) { return 2 * std::asin(0.5 * chord); }

  /// (2/π) K(sin(A/2)), by the arithmetic-geometric mean. MODEL.md eq. (6.1).
  static double PeriodRatio(double amplitude) {
    double a = 1;
    double b = std::cos(0.5 * amplitude);
    while (std::abs(a - b) > 1e-15 * a) {
      const double mean = 0.5 * (a + b);
      b = std::sqrt(a * b);
      a = mean;
    }
    return 1 / a;
  }

  template <typename T>
  class Recurrence {
   public:
    template <int n>
    [[gnu::always_inline]] double Next(const Series<double>& angle, const Series<double>& rate) {
      return sine_.Next<n>(angle[0], rate);
    }
    template <int n>
    [[gnu::always_inline]] PartialsFor<T> PartialsOf(const Series<PartialsFor<T>>& angle) {
      return sine_.PartialsOf<n>(angle, next_);
    }

   private:
    SineSeries sine_;
    PartialsFor<T> next_;
  };
};

}  // namespace pendulum
