// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pendulum/model/dual.h"

namespace pendulum {

/// The highest order of a Taylor expansion: OrderForTolerance returns it for a local tolerance of 4e-15.
inline constexpr int kMaxOrder = 25;

/// Coefficients of a truncated Taylor series Σ c_n τⁿ, τ in s; T is double or Dual.
template <typename T>
using Series = std::array<T, kMaxOrder + 1>;

/// 1/n, tabulated because a division would delay every coefficient.
inline constexpr std::array<double, kMaxOrder + 1> kInverse = [] {
  std::array<double, kMaxOrder + 1> inverse{};
  for (std::size_t n = 1; n < inverse.size(); ++n) inverse[n] = 1.0 / static_cast<double>(n);
  return inverse;
}();

/// Coefficient n of the product of two series.  MODEL.md eq. (4.2).
template <typename T>
T CauchyProduct(const Series<T>& x, const Series<T>& y, int n) {
  T sum = x[0] * y[n];
  for (int k = 1; k <= n; ++k) sum += x[k] * y[n - k];
  return sum;
}

/// Coefficient n of the square of a series: half the work of CauchyProduct(x, x, n).
template <typename T>
T SquareCoefficient(const Series<T>& x, int n) {
  T sum = n % 2 == 0 ? 0.5 * (x[n / 2] * x[n / 2]) : T(0.0);
  for (int k = (n + 1) / 2 - 1; k >= 0; --k) sum += x[k] * x[n - k];
  return 2.0 * sum;
}

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
  /// Terms k <= kOuter and their mirror images are added one by one, because they become known late.
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

}  // namespace pendulum
