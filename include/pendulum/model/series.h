// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

}  // namespace pendulum
