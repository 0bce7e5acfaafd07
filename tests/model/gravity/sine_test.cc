// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/gravity/sine.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <boost/math/differentiation/autodiff.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/coefficients.h"

namespace pendulum::sine_test {
namespace {

using testing::DoubleNear;

using Exact = boost::multiprecision::cpp_bin_float_50;

/// Taylor coefficients of sin(Σ c_n τⁿ) by Boost's automatic differentiation with 50 digits.
Series<double> SineByAutodiff(const Series<double>& angle) {
  const auto tau = boost::math::differentiation::make_fvar<Exact, kMaxOrder>(Exact(0));
  auto sum = tau * Exact(0) + Exact(angle[kMaxOrder]);
  for (int n = kMaxOrder - 1; n >= 0; --n) sum = sum * tau + Exact(angle[n]);
  const auto sine = sin(sum);
  Series<double> coefficients;
  Exact factorial = 1;
  for (int n = 0; n <= kMaxOrder; ++n) {
    if (n > 0) factorial *= n;
    coefficients[n] = static_cast<double>(Exact(sine.derivative(n) / factorial));
  }
  return coefficients;
}

/// Coefficients by SineSeries. At each order only the coefficients that its contract allows it to read are given.
Series<double> SineInOrder(const Series<double>& angle) {
  SineSeries sine;
  Series<double> known_rate = Coefficients({});
  Series<double> coefficients;
  const auto next = [&]<int n>() {
    if (n > 0) known_rate[n - 1] = n * angle[n];
    coefficients[n] = sine.Next<n>(angle[0], known_rate);
  };
  [&]<int... n>(std::integer_sequence<int, n...>) { (next.template operator()<n>(), ...); }
  (std::make_integer_sequence<int, kMaxOrder + 1>());
  return coefficients;
}

/// The tolerance is relative to the largest of the coefficients n and above, because their terms can cancel.
void ExpectSine(const Series<double>& angle) {
  const Series<double> expected = SineByAutodiff(angle);
  const Series<double> actual = SineInOrder(angle);
  double scale = 0;
  for (int n = kMaxOrder; n >= 0; --n) {
    scale = std::max(scale, std::abs(expected[n]));
    EXPECT_THAT(actual[n], DoubleNear(expected[n], 1e-14 * scale)) << "coefficient " << n << " from " << angle[0];
  }
}

TEST(SineSeries, IsTheTaylorSeriesForRandomSeries) {
  std::mt19937_64 generator(20260802);
  for (const double decay : {0.3, 0.6, 1.0}) {
    Series<double> angle = RandomSeries(generator, decay);
    for (const double start : {0.4, -1.7, 3.1}) {
      angle[0] = start;
      ExpectSine(angle);
    }
  }
}

TEST(SineSeries, IsTheTaylorSeriesFromRestAtNinetyDegrees) {
  Series<double> angle{};
  angle[0] = std::acos(0.0);
  angle[2] = -0.5;
  angle[6] = 1.0 / 240;
  ExpectSine(angle);
}

// θ = τ: sin τ = τ - τ³/3! + τ⁵/5! - ...
TEST(SineSeries, IsTheTextbookSeriesOfTheSine) {
  Series<double> angle{};
  angle[1] = 1;
  const Series<double> sine = SineInOrder(angle);
  double factorial = 1;
  for (int n = 0; n <= kMaxOrder; ++n) {
    if (n > 0) factorial *= n;
    const double sign = n % 4 == 1 ? 1.0 : n % 4 == 3 ? -1.0 : 0.0;
    EXPECT_DOUBLE_EQ(sine[n], sign / factorial) << "coefficient " << n;
  }
}

}  // namespace
}  // namespace pendulum::sine_test
