// SPDX-License-Identifier: Apache-2.0
#include "fitting/effects/effect_estimates.h"

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace pendulum::effect_estimates_test {
namespace {

/// One parameter (a mean) and two effects (a slope and a curvature) of readings with unit noise.
struct Regression {
  Eigen::MatrixXd columns;
  Eigen::VectorXd residual;

  EffectSums Sums() const {
    EffectSums sums;
    sums.information = sums.meat = columns.transpose() * columns;
    sums.score = columns.transpose() * residual;
    sums.parameters = 1;
    return sums;
  }
};

Regression MakeRegression(double slope, std::uint64_t seed) {
  constexpr Eigen::Index kSamples = 200;
  Regression regression;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(kSamples, 0, 1);
  regression.columns.resize(kSamples, 3);
  regression.columns << Eigen::VectorXd::Ones(kSamples), x, x.array().square();
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  regression.residual = slope * x;
  for (double& r : regression.residual) r += normal(generator);
  return regression;
}

/// One prior with mean 0.
EffectPriors Priors(double precision) { return {Eigen::VectorXd::Constant(1, precision), Eigen::VectorXd::Zero(1)}; }

TEST(EffectEstimates, WithoutPriorAreThoseOfLeastSquares) {
  const Regression regression = MakeRegression(3, 1);
  const EffectSizes sizes = EstimateEffects(regression.Sums(), {1}, Priors(0));
  const Eigen::MatrixXd design = regression.columns.leftCols(2);
  const Eigen::VectorXd expected = design.colPivHouseholderQr().solve(regression.residual);
  EXPECT_NEAR(sizes.mean[0], expected[1], 1e-9);
  EXPECT_NEAR(sizes.covariance(0, 0), (design.transpose() * design).inverse()(1, 1), 1e-9);
}

TEST(EffectEstimates, WithAPriorAreItsWeightedMeanWithTheData) {
  const Regression regression = MakeRegression(3, 2);
  const EffectSizes alone = EstimateEffects(regression.Sums(), {1}, Priors(0));
  const double precision = 1 / alone.covariance(0, 0), prior = 4.0;
  const EffectSizes sizes = EstimateEffects(regression.Sums(), {1}, Priors(prior));
  EXPECT_NEAR(sizes.mean[0], alone.mean[0] * precision / (precision + prior), 1e-9);
  EXPECT_NEAR(sizes.covariance(0, 0), 1 / (precision + prior), 1e-9);
}

// For one effect: noise of the score ten times its information a leaves the precision a / 10 of the data.
TEST(EffectEstimates, AreNeverLessCertainThanTheirPrior) {
  EffectSums sums;
  sums.information = Eigen::MatrixXd::Identity(2, 2);
  sums.meat = 10 * sums.information;
  sums.score = Eigen::VectorXd::Constant(2, 1.0);
  sums.parameters = 1;
  const EffectSizes sizes = EstimateEffects(sums, {1}, Priors(2));
  EXPECT_NEAR(sizes.covariance(0, 0), 1 / (0.1 + 2), 1e-12);
  EXPECT_NEAR(sizes.mean[0], 0.1 / (0.1 + 2), 1e-12);
}

TEST(EffectTest, OfOneEffectIsTheSquareOfEstimateOverError) {
  const Regression regression = MakeRegression(1, 3);
  const EffectSizes alone = EstimateEffects(regression.Sums(), {1}, Priors(0));
  const EffectTest test = TestEffects(regression.Sums(), {}, {1});
  EXPECT_EQ(test.freedom, 1);
  EXPECT_NEAR(test.chi_square, alone.mean[0] * alone.mean[0] / alone.covariance(0, 0), 1e-8);
}

TEST(EffectTest, OfChiSquareHasTheSignificanceOfANormalVariable) {
  // 3.841 and 18.467: upper 5 % of chi-square with 1 degree of freedom and 0.1 % with 4 degrees (Abramowitz and Stegun,
  // Table 26.8). The normal variable with the same tail is 1.645, and 3.090. Wilson and Hilferty are good to 0.05.
  const auto significance_of = [](double chi_square, int freedom) {
    EffectSums sums;
    sums.information = sums.meat = Eigen::MatrixXd::Identity(freedom + 1, freedom + 1);
    sums.score = Eigen::VectorXd::Constant(freedom + 1, std::sqrt(chi_square / freedom));
    sums.score[0] = 0;
    sums.parameters = 1;
    std::vector<Eigen::Index> tested;
    for (Eigen::Index k = 1; k <= freedom; ++k) tested.push_back(k);
    return TestEffects(sums, {}, tested).significance;
  };
  EXPECT_NEAR(significance_of(3.841, 1), 1.645, 0.05);
  EXPECT_NEAR(significance_of(18.467, 4), 3.090, 0.05);
}

TEST(EffectTest, OfAnEffectThatTheParametersTakeUpHasNoFreedom) {
  Regression regression = MakeRegression(1, 4);
  regression.columns.col(1) = 2 * regression.columns.col(0);
  EXPECT_EQ(TestEffects(regression.Sums(), {}, {1}).freedom, 0);
  EXPECT_EQ(TestEffects(regression.Sums(), {}, {1}).significance, 0);
}

TEST(EffectTest, RarelyNamesWhatIsNotThere) {
  constexpr int kRuns = 300;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    sum += TestEffects(MakeRegression(0, 100 + static_cast<std::uint64_t>(run)).Sums(), {}, {1, 2}).chi_square;
  }
  // The mean of chi-square is the number of degrees of freedom, its variance twice that.
  EXPECT_NEAR(sum / kRuns, 2, 4 * std::sqrt(4.0 / kRuns));
}

}  // namespace
}  // namespace pendulum::effect_estimates_test
