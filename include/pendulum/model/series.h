// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pendulum {

/// The highest order of a Taylor expansion: what OrderForTolerance asks for at a local tolerance of 4e-15.
inline constexpr int kMaxOrder = 25;

/// Coefficients of a truncated Taylor series Σ c_n τⁿ, τ in s; T is double or a dual number (ceres::Jet).
template <typename T>
using Series = std::array<T, kMaxOrder + 1>;

/// A dual number: value `a` and partial derivatives `v`, as in ceres::Jet, which this floor does not include.
template <typename T>
concept DualNumber = requires(T x) {
  x.a;
  x.v;
};

template <typename T>
double Value(const T& x) {
  if constexpr (DualNumber<T>) {
    return x.a;
  } else {
    return x;
  }
}

/// 1/n: a division would hold up every coefficient.
inline constexpr std::array<double, kMaxOrder + 1> kInverse = [] {
  std::array<double, kMaxOrder + 1> inverse{};
  for (std::size_t n = 1; n < inverse.size(); ++n) inverse[n] = 1.0 / static_cast<double>(n);
  return inverse;
}();

/// Coefficient n of the product of two series.  MODEL.md eq. (13).
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

/// Coefficients of sin θ and cos θ along a trajectory, one after the other, by the coupled recurrence n sin_n = Σ ω_j
/// cos_{n-1-j}, n cos_n = -Σ ω_j sin_{n-1-j} with ω = θ' (MODEL.md eq. (14)). Sums go from the middle outwards: what
/// was known last is added last, and nothing else has to wait for it.
class SineSeries {
 public:
  /// Coefficient n of the sine, n = 0, 1, 2, ... in this order, from θ_0 and coefficients 0..n-1 of ω.
  template <int n>
  double Next(double angle, const Series<double>& rate) {
    if constexpr (n == 0) {
      sin_[0] = std::sin(angle);
      cos_[0] = std::cos(angle);
    } else if constexpr (n == 1) {
      sin_[1] = rate[0] * cos_[0];
      cos_[1] = -rate[0] * sin_[0];
    } else {
      Advance<n>(rate);
    }
    return sin_[n];
  }

  /// Partial derivatives of coefficient n, which is known already, from those of coefficients 0..n of θ: d sin θ = cos
  /// θ dθ (MODEL.md eq. (15)) costs one product of series per parameter, the recurrence in dual numbers four.
  template <int n, DualNumber T>
  auto Partials(const Series<T>& angle) const {
    decltype(T::v) low = cos_[n - n / 2] * angle[n / 2].v;
    if constexpr (n > 1) {
      decltype(T::v) high = n % 2 == 1 ? cos_[n / 2] * angle[n - n / 2].v : cos_[n / 2 - 1] * angle[n / 2 + 1].v;
#pragma GCC unroll 32
      for (int k = n / 2 - 1; k >= 0; --k) {
        low += cos_[n - k] * angle[k].v;
        if (n % 2 == 1 || k > 0) high += cos_[k - 1 + n % 2] * angle[n - k + 1 - n % 2].v;
      }
      low += high;
    } else if constexpr (n == 1) {
      low += cos_[0] * angle[1].v;
    }
    return low;
  }

 private:
  /// Partial sums of n sin_n and -n cos_n.
  struct Sums {
    double sine = 0, cosine = 0;

    void Add(double rate, double cosine_before, double sine_before) {
      sine += rate * cosine_before;
      cosine += rate * sine_before;
    }
  };

  /// n > 1.
  template <int n>
  void Advance(const Series<double>& rate) {
    const int last = n - 1;
    Sums low;
    Sums high;
#pragma GCC unroll 32
    for (int k = last / 2; k > 0; --k) {
      low.Add(rate[k], cos_[last - k], sin_[last - k]);
      if (k != last - k) high.Add(rate[last - k], cos_[k], sin_[k]);
    }
    const double first = rate[0] * kInverse[n];
    sin_[n] = (low.sine + high.sine) * kInverse[n] + rate[last] * (cos_[0] * kInverse[n]) + first * cos_[last];
    cos_[n] = -((low.cosine + high.cosine) * kInverse[n] + rate[last] * (sin_[0] * kInverse[n]) + first * sin_[last]);
  }

  Series<double> sin_;
  Series<double> cos_;
};

}  // namespace pendulum
