// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/score_supremum.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"

namespace pendulum::score_supremum_test {
namespace {

using Eigen::MatrixXd;
using testing::DoubleNear;

MatrixXd Seeded(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937_64 generator(20261122);
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatrixXd matrix(rows, columns);
  for (double& x : matrix.reshaped()) x = uniform(generator);
  return matrix;
}

/// Three standard deviations of a share p of 19999 draws.
double Scatter(double p) { return 3 * std::sqrt(p * (1 - p) / 19'999); }

// One shape: the tail is half the tail of χ²(1); its 5 % point is 2.7055.
TEST(SupremumTail, IsHalfAChiSquareForOneShape) {
  const MatrixXd shapes = Seeded(50, 1);
  EXPECT_THAT(SupremumTail(MatrixXd(50, 0), shapes, 2.705543, 1), DoubleNear(0.05, Scatter(0.05)));
}

// Orthogonal shapes are independent: 1 - Φ(√u)^G.
TEST(SupremumTail, IsTheTailOfTheMaximumForIndependentShapes) {
  const double expected = 1 - std::pow(0.5 * std::erfc(-2 / std::sqrt(2.0)), 5);
  EXPECT_THAT(SupremumTail(MatrixXd(9, 0), MatrixXd::Identity(9, 5), 4, 2), DoubleNear(expected, Scatter(expected)));
}

// Without the direction of the nuisance (1, 0, ...) both shapes are (0, 1, ...): one shape.
TEST(SupremumTail, UsesOnlyThePartsOfShapesThatTheNuisanceDoesNotExplain) {
  MatrixXd nuisance = MatrixXd::Zero(4, 1);
  nuisance(0, 0) = 7;
  MatrixXd shapes = MatrixXd::Zero(4, 2);
  shapes.col(0) << 3, 1, 0, 0;
  shapes.col(1) << -5, 2, 0, 0;  // the same direction after removal of the nuisance
  EXPECT_THAT(SupremumTail(nuisance, shapes, 2.705543, 3), DoubleNear(0.05, Scatter(0.05)));
}

TEST(SupremumTail, IsOneIfTheNuisanceExplainsAllShapesOrTheStatisticIsZero) {
  const MatrixXd nuisance = Seeded(20, 3);
  EXPECT_EQ(SupremumTail(nuisance, nuisance.leftCols(2), 5, 1), 1);
  EXPECT_EQ(SupremumTail(nuisance, Seeded(20, 5).rightCols(2), 0, 1), 1);
}

TEST(SupremumTail, DoesNotDependOnUnits) {
  const MatrixXd all = Seeded(30, 6);
  const MatrixXd nuisance = all.leftCols(2);
  MatrixXd shapes = all.rightCols(4);
  const double p = SupremumTail(nuisance, shapes, 3, 5);
  shapes.col(2) *= 1e-9;
  EXPECT_NEAR(SupremumTail(1e6 * nuisance, shapes, 3, 5), p, 1e-3);
}

}  // namespace
}  // namespace pendulum::score_supremum_test
