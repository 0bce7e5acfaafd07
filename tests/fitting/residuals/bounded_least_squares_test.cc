// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/bounded_least_squares.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <Eigen/LU>
#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::bounded_least_squares_test {
namespace {

using testing::DoubleNear;
using testing::Ge;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::MatrixXd NormalMatrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped()) entry = normal(generator);
  return matrix;
}

TEST(BoundedLeastSquares, IsTheSolutionOfTheNormalEquationsWithoutBounds) {
  const Eigen::MatrixXd matrix = NormalMatrix(20, 4, 1);
  const Eigen::VectorXd value = NormalMatrix(20, 1, 2);
  const Eigen::VectorXd bound = Eigen::VectorXd::Constant(4, kInfinity);
  const Eigen::VectorXd expected = (matrix.transpose() * matrix).inverse() * matrix.transpose() * value;
  EXPECT_THAT((BoundedLeastSquares(matrix, value, -bound, bound) - expected).norm(), DoubleNear(0, 1e-12));
}

/// Conditions of Karush, Kuhn and Tucker: at a bound the sum decreases only outwards, elsewhere its gradient is 0. For
/// a convex sum these are sufficient.
TEST(BoundedLeastSquares, SatisfiesTheOptimalityConditionsWithinBounds) {
  int bounded = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Eigen::Index size = 1 + static_cast<Eigen::Index>(seed % 9);
    Eigen::MatrixXd matrix = NormalMatrix(12, size, seed);
    if (size > 2) matrix.col(1) = matrix.col(0) + 0.1 * matrix.col(2);  // linearly dependent
    const Eigen::VectorXd value = NormalMatrix(12, 1, seed + 1000);
    const Eigen::VectorXd lowest = -0.2 * NormalMatrix(size, 1, seed + 2000).cwiseAbs();
    const Eigen::VectorXd highest = 0.2 * NormalMatrix(size, 1, seed + 3000).cwiseAbs();
    const Eigen::VectorXd place = BoundedLeastSquares(matrix, value, lowest, highest);
    const Eigen::VectorXd pull = matrix.transpose() * (value - matrix * place);
    for (Eigen::Index i = 0; i < size; ++i) {
      EXPECT_TRUE(lowest[i] <= place[i] && place[i] <= highest[i]) << seed;
      const bool low = place[i]<lowest[i] + 1e-14, high = place[i]> highest[i] - 1e-14;
      bounded += low || high;
      const double outwards = low ? -pull[i] : high ? pull[i] : -std::abs(pull[i]);
      EXPECT_THAT(outwards, Ge(-1e-9)) << seed;
    }
  }
  EXPECT_THAT(bounded, Ge(200));  // bounds are active in most examples
}

TEST(BoundedLeastSquares, DoesNotDependOnTheUnitsOfTheColumns) {
  const Eigen::MatrixXd matrix = NormalMatrix(30, 3, 3);
  const Eigen::VectorXd value = matrix * Eigen::Vector3d(1, 2, 3);
  const Eigen::Vector3d unit(1e-9, 1, 1e9);
  const Eigen::Vector3d bound(2, 1.5, 5);
  const Eigen::Vector3d place = BoundedLeastSquares(matrix, value, -bound, bound);
  const Eigen::Vector3d scaled =
      BoundedLeastSquares(matrix * unit.asDiagonal(), value, -bound.cwiseQuotient(unit), bound.cwiseQuotient(unit));
  EXPECT_EQ(place[1], 1.5);
  EXPECT_THAT((scaled.cwiseProduct(unit) - place).norm(), DoubleNear(0, 1e-12));
}

TEST(BoundedLeastSquares, SplitsEquallyBetweenEqualColumns) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Ones(5, 2);
  const Eigen::VectorXd value = Eigen::VectorXd::Ones(5);
  const Eigen::Vector2d far(kInfinity, kInfinity);
  EXPECT_THAT((BoundedLeastSquares(matrix, value, -far, far) - Eigen::Vector2d(0.5, 0.5)).norm(), DoubleNear(0, 1e-12));
  // If one of them is limited, the other takes its part.
  const Eigen::VectorXd place = BoundedLeastSquares(matrix, value, -far, Eigen::Vector2d(0.25, kInfinity));
  EXPECT_THAT((place - Eigen::Vector2d(0.25, 0.75)).norm(), DoubleNear(0, 1e-12));
}

TEST(BoundedLeastSquares, IgnoresColumnsOfZerosAndAcceptsAMatrixWithoutColumns) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Ones(5, 2);
  matrix.col(1).setZero();
  const Eigen::Vector2d far(kInfinity, kInfinity);
  EXPECT_THAT((BoundedLeastSquares(matrix, Eigen::VectorXd::Ones(5), -far, far) - Eigen::Vector2d(1, 0)).norm(),
              DoubleNear(0, 1e-12));
  EXPECT_EQ(BoundedLeastSquares(Eigen::MatrixXd(5, 0), Eigen::VectorXd::Ones(5), {}, {}).size(), 0);
}

}  // namespace
}  // namespace pendulum::bounded_least_squares_test
