// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/least_squares.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace pendulum::least_squares_test {
namespace {

// Priors on parameters 0 and 2 of three. By hand at (1, 7, 3): residuals (1 - 2) · 3 = -3 and (3 + 1) · 0.5 = 2.
const std::vector<PriorTerm> kPriors = {{0, 2.0, 3.0}, {2, -1.0, 0.5}};
const std::vector<double> kParameters = {1, 7, 3};

TEST(PriorSum, IsTheSumOfSquaredStandardizedDistances) {
  EXPECT_DOUBLE_EQ(PriorSum(kPriors, kParameters), 9.0 + 4.0);
  const std::vector<double> means = {2, 7, -1};
  EXPECT_EQ(PriorSum(kPriors, means), 0);
  EXPECT_EQ(PriorSum({}, kParameters), 0);
}

TEST(AddPriors, AddsInformationGradientAndDeviance) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Ones(4, 4);
  AddPriors(kPriors, kParameters, &sums);
  // w² on the diagonal, w r in the last row and column, r² in the corner.
  const Eigen::Matrix4d added{{9, 0, 0, -9}, {0, 0, 0, 0}, {0, 0, 0.25, 1}, {-9, 0, 1, 13}};
  EXPECT_TRUE(sums.isApprox(Eigen::Matrix4d::Ones() + added, 1e-15)) << sums;
}

TEST(AddPriors, AddsNothingWithoutPriors) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Constant(4, 4, 2.5);
  AddPriors({}, kParameters, &sums);
  EXPECT_EQ(sums, Eigen::MatrixXd::Constant(4, 4, 2.5));
}

// Two measurements of one quantity, 2 ± 1/3 and 1 ± 1/4, evaluated at 0: information 9 + 16, gradients -3 · 6 and -4 ·
// 4.
TEST(AddPriors, AddsRepeatedPriorsOfOneParameter) {
  const std::vector<PriorTerm> twice = {{0, 2.0, 3.0}, {0, 1.0, 4.0}};
  const std::vector<double> at = {0};
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(2, 2);
  AddPriors(twice, at, &sums);
  EXPECT_DOUBLE_EQ(sums(0, 0), 25);
  EXPECT_DOUBLE_EQ(sums(0, 1), -34);
  EXPECT_DOUBLE_EQ(sums(1, 0), -34);
  EXPECT_DOUBLE_EQ(sums(1, 1), 52);
}

// A sum of squares is a parabola, so central differences are exact: ∂/∂p Σ r² = 2 J'r.
TEST(AddPriors, AddsHalfTheGradientOfThePriorSum) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(4, 4);
  AddPriors(kPriors, kParameters, &sums);
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> lower = kParameters, upper = kParameters;
    lower[i] -= 0.5;
    upper[i] += 0.5;
    const double slope = PriorSum(kPriors, upper) - PriorSum(kPriors, lower);
    EXPECT_NEAR(2 * sums(static_cast<Eigen::Index>(i), 3), slope, 1e-12) << i;
  }
}

// ---- Compressed residuals ----------------------------------------------------------------------------------------

struct Compressed {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

Compressed Compress(const Eigen::MatrixXd& sums) {
  const Eigen::Index size = sums.rows() - 1;
  Compressed compressed{Eigen::VectorXd(size + 1), Eigen::MatrixXd(size + 1, size)};
  std::vector<double*> columns;
  for (Eigen::Index j = 0; j < size; ++j) columns.push_back(compressed.jacobian.col(j).data());
  CompressResiduals(sums, compressed.residuals.data(), columns.data());
  return compressed;
}

/// Products of residuals and derivatives, in the form of Sums.
Eigen::MatrixXd SumsOf(const Compressed& of) {
  Eigen::MatrixXd rows(of.jacobian.rows(), of.jacobian.cols() + 1);
  rows << of.jacobian, of.residuals;
  return rows.transpose() * rows;
}

TEST(CompressResiduals, PreservesProductsOfResidualsAtAnyScale) {
  std::mt19937_64 generator(20261123);
  std::normal_distribution<double> normal;
  for (const Eigen::Index size : {1, 3, kMaxCompressed}) {
    Compressed all{Eigen::VectorXd(40), Eigen::MatrixXd(40, size)};
    for (Eigen::Index i = 0; i < 40; ++i) {
      all.residuals[i] = normal(generator);
      for (Eigen::Index j = 0; j < size; ++j) all.jacobian(i, j) = std::pow(10.0, 2 * j - size) * normal(generator);
    }
    const Eigen::MatrixXd sums = SumsOf(all);
    const Eigen::VectorXd scale = sums.diagonal().cwiseSqrt();
    const Eigen::MatrixXd difference = SumsOf(Compress(sums)) - sums;
    EXPECT_LT(difference.cwiseQuotient(scale * scale.transpose()).cwiseAbs().maxCoeff(), 1e-12) << size;
  }
}

// The second parameter has twice the effect of the first; the third has no effect.
TEST(CompressResiduals, StaysFiniteForUndeterminedParameters) {
  Compressed all{Eigen::Vector3d(1, 2, 4), Eigen::Matrix3d{{1, 2, 0}, {3, 6, 0}, {-1, -2, 0}}};
  const Compressed compressed = Compress(SumsOf(all));
  EXPECT_TRUE(SumsOf(compressed).isApprox(SumsOf(all), 1e-12)) << SumsOf(compressed);
}

// A gradient too large for the deviance, as the information of a likelihood can produce: 4² / 1 > 9.
TEST(CompressResiduals, PreservesDevianceAndGradientForInconsistentSums) {
  const Compressed compressed = Compress(Eigen::Matrix2d{{1, 4}, {4, 9}});
  const Eigen::MatrixXd sums = SumsOf(compressed);
  EXPECT_NEAR(sums(1, 1), 9, 1e-14);
  EXPECT_NEAR(sums(0, 1), 4, 1e-14);
  EXPECT_NEAR(sums(0, 0), 16.0 / 9, 1e-14);
}

TEST(CompressResiduals, SkipsColumnsThatAreNotRequested) {
  Eigen::Vector3d residuals;
  Eigen::Vector3d column;
  double* columns[] = {nullptr, column.data()};
  CompressResiduals(Eigen::Matrix3d{{4, 0, 2}, {0, 9, 3}, {2, 3, 5}}, residuals.data(), columns);
  EXPECT_NEAR(column.norm(), 3, 1e-14);
  EXPECT_NEAR(column.dot(residuals), 3, 1e-14);
}

}  // namespace
}  // namespace pendulum::least_squares_test
