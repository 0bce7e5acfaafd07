// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/series.h"

#include <array>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/coefficients.h"

namespace pendulum::series_test {
namespace {

using testing::DoubleNear;

// (1 + 2x + 3x² + 5x³)(4 - 5x + 6x² - 7x³), multiplied by hand.
TEST(CauchyProduct, MultipliesPolynomials) {
  const Series<double> x = Coefficients({1, 2, 3, 5, 0, 0, 0});
  const Series<double> y = Coefficients({4, -5, 6, -7, 0, 0, 0});
  const std::array<double, 7> expected = {4, 3, 8, 10, -21, 9, -35};
  for (int n = 0; n < 7; ++n) EXPECT_EQ(CauchyProduct(x, y, n), expected[n]) << "coefficient " << n;
}

// (1 + 2x + 3x² + 4x³)², multiplied by hand.
TEST(SquareCoefficient, SquaresPolynomials) {
  const Series<double> x = Coefficients({1, 2, 3, 4, 0, 0, 0});
  const std::array<double, 7> expected = {1, 4, 10, 20, 25, 24, 16};
  for (int n = 0; n < 7; ++n) EXPECT_EQ(SquareCoefficient(x, n), expected[n]) << "coefficient " << n;
}

TEST(SquareCoefficient, IsTheProductWithItselfAtEveryOrder) {
  std::mt19937_64 generator(20260801);
  const Series<double> x = RandomSeries(generator, 1.0);
  for (int n = 0; n <= kMaxOrder; ++n) {
    EXPECT_THAT(SquareCoefficient(x, n), DoubleNear(CauchyProduct(x, x, n), 1e-14)) << "coefficient " << n;
  }
}

TEST(CauchyProduct, UsesNoCoefficientBeyondTheRequestedCoefficient) {
  const Series<double> x = Coefficients({1, 2});
  EXPECT_EQ(CauchyProduct(x, x, 1), 4);
  EXPECT_EQ(SquareCoefficient(x, 1), 4);
}

}  // namespace
}  // namespace pendulum::series_test
