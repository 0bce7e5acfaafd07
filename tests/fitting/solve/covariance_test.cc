// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/covariance.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::covariance_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// 50 x P: monomials of a variable on [-1, 1], each column with a different scale.
Eigen::MatrixXd Jacobian(int parameters) {
  Eigen::MatrixXd jacobian(50, parameters);
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < parameters; ++j) jacobian(i, j) = std::pow(10.0, 3 * j - 4) * std::pow(-1 + i / 24.5, j);
  }
  return jacobian;
}

InformationInverse InvertAll(const Eigen::MatrixXd& jacobian) {
  std::vector<int> all(static_cast<std::size_t>(jacobian.cols()));
  std::iota(all.begin(), all.end(), 0);
  return InvertInformation(jacobian.transpose() * jacobian, all);
}

TEST(InvertInformation, IsTheInverse) {
  const Eigen::MatrixXd jacobian = Jacobian(5);
  const InformationInverse inverse = InvertAll(jacobian);
  ASSERT_TRUE(inverse.identifiable);
  const Eigen::MatrixXd product = inverse.matrix * (jacobian.transpose() * jacobian);
  const Eigen::VectorXd size = jacobian.colwise().norm();
  // Entry (i, j) has the unit of column j divided by that of column i.
  EXPECT_LT((size.asDiagonal() * product * size.cwiseInverse().asDiagonal() - Eigen::MatrixXd::Identity(5, 5)).norm(),
            1e-11);
  const Eigen::MatrixXd unit_free = size.asDiagonal() * inverse.matrix * size.asDiagonal();
  EXPECT_LT((unit_free - unit_free.transpose()).norm(), 1e-12 * unit_free.norm());
  EXPECT_THAT(inverse.direction, IsEmpty());
}

TEST(InvertInformation, HoldsOtherParametersFixed) {
  const Eigen::MatrixXd jacobian = Jacobian(5);
  const InformationInverse inverse = InvertInformation(jacobian.transpose() * jacobian, {1, 3});
  Eigen::MatrixXd two(50, 2);
  two << jacobian.col(1), jacobian.col(3);
  const Eigen::Matrix2d expected = (two.transpose() * two).inverse();
  ASSERT_TRUE(inverse.identifiable);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(inverse.matrix(i, j) / expected(i, j), 1, 1e-10);
  }
}

TEST(InvertInformation, IsEmptyWithoutParameters) {
  const InformationInverse inverse = InvertInformation(Eigen::MatrixXd::Identity(3, 3), {});
  EXPECT_TRUE(inverse.identifiable);
  EXPECT_EQ(inverse.matrix.size(), 0);
}

TEST(InvertInformation, NamesTheParametersOfAnUndeterminedCombination) {
  Eigen::MatrixXd jacobian = Jacobian(5);
  jacobian.col(3) = 1e6 * jacobian.col(1) - 2e3 * jacobian.col(2);
  const InformationInverse inverse = InvertAll(jacobian);
  EXPECT_FALSE(inverse.identifiable);
  EXPECT_EQ(inverse.matrix.size(), 0);
  EXPECT_THAT(inverse.direction, ElementsAre(1, 2, 3));
}

TEST(InvertInformation, ReportsIndicesAmongAllParameters) {
  Eigen::MatrixXd jacobian = Jacobian(5);
  jacobian.col(4) = 7 * jacobian.col(2);
  const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  EXPECT_THAT(InvertInformation(information, {0, 2, 4}).direction, ElementsAre(2, 4));
  EXPECT_TRUE(InvertInformation(information, {0, 1, 2, 3}).identifiable);
}

TEST(InvertInformation, NamesUndeterminedParameters) {
  Eigen::MatrixXd jacobian = Jacobian(4);
  jacobian.col(2).setZero();
  jacobian.col(0).setZero();
  EXPECT_FALSE(InvertAll(jacobian).identifiable);
  EXPECT_THAT(InvertAll(jacobian).direction, ElementsAre(0, 2));
}

TEST(InvertInformation, AcceptsACorrelationThatDiffersFromOneByMoreThanRounding) {
  Eigen::MatrixXd jacobian = Jacobian(4);
  jacobian.col(3) = jacobian.col(1) + 1e-5 * jacobian.col(1).norm() / jacobian.col(2).norm() * jacobian.col(2);
  const std::vector<int> without_quadratic = {0, 1, 3};
  Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  EXPECT_TRUE(InvertInformation(information, without_quadratic).identifiable);  // 1 - correlation is about 5e-11
  jacobian.col(3) = jacobian.col(1) + 1e-7 * jacobian.col(1).norm() / jacobian.col(2).norm() * jacobian.col(2);
  information = jacobian.transpose() * jacobian;
  EXPECT_FALSE(InvertInformation(information, without_quadratic).identifiable);  // 5e-15: lost to rounding in the sums
}

TEST(InvertInformation, RefusesNaN) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(3, 3);
  information(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(InvertInformation(information, {0, 1, 2}).identifiable);
}

}  // namespace
}  // namespace pendulum::covariance_test
