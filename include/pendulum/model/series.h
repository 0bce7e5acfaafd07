// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace pendulum {

/// The highest order of a Taylor expansion: what OrderForTolerance asks for at a local tolerance of 1e-17.
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
  for (int k = 0; k < (n + 1) / 2; ++k) sum += x[k] * x[n - k];
  return 2.0 * sum;
}

/// Coefficients of sin θ along a trajectory, one after the other. Values by the coupled recurrence n sin_n = Σ ω_j
/// cos_{n-1-j}, n cos_n = -Σ ω_j sin_{n-1-j} with ω = θ' (MODEL.md eq. (14)); partial derivatives of a dual number from
/// d sin θ = cos θ dθ (MODEL.md eq. (15)), which costs one product of series per parameter instead of four.
template <typename T>
class SineSeries {
 public:
  /// Coefficient n, n = 0, 1, 2, ... in this order, from coefficients 0..n of θ and 0..n-1 of ω.
  T Next(int n, const Series<T>& angle, const Series<T>& rate) {
    if (n == 0) {
      sin_[0] = std::sin(Value(angle[0]));
      cos_[0] = std::cos(Value(angle[0]));
    } else {
      Advance(n, rate);
    }
    if constexpr (DualNumber<T>) {
      T result(sin_[n]);
      for (int j = 0; j <= n; ++j) result.v += cos_[n - j] * angle[j].v;
      return result;
    } else {
      return sin_[n];
    }
  }

 private:
  /// Two partial sums of each, so that one addition need not wait for the other.
  void Advance(int n, const Series<T>& rate) {
    std::array<double, 2> sin_sum{};
    std::array<double, 2> cos_sum{};
    for (int j = 0; j + 1 < n; j += 2) {
      for (int odd = 0; odd < 2; ++odd) {
        sin_sum[odd] += Value(rate[j + odd]) * cos_[n - 1 - j - odd];
        cos_sum[odd] += Value(rate[j + odd]) * sin_[n - 1 - j - odd];
      }
    }
    if (n % 2 == 1) {
      sin_sum[0] += Value(rate[n - 1]) * cos_[0];
      cos_sum[0] += Value(rate[n - 1]) * sin_[0];
    }
    sin_[n] = (sin_sum[0] + sin_sum[1]) / n;
    cos_[n] = -(cos_sum[0] + cos_sum[1]) / n;
  }

  Series<double> sin_;
  Series<double> cos_;
};

}  // namespace pendulum
