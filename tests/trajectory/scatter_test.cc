// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/scatter.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/trajectory/synthetic.h"

namespace pendulum::scatter_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

constexpr int kSeeds = 4000;
const double kRootOfSeeds = std::sqrt(kSeeds);
constexpr double kTolerance = 4;  // standard errors: a correct generator fails one check in 16,000

constexpr ParameterInfo kBounded{"viscous", "b", "", "", 0.0, kUnbounded, ""};

/// Row s contains the values for seed s + 1.
Eigen::MatrixXd Draws(const std::vector<ScatteredParameter>& parameters, OrderedPair order = {}) {
  Eigen::MatrixXd draws(kSeeds, static_cast<Eigen::Index>(parameters.size()));
  for (int s = 0; s < kSeeds; ++s) {
    const auto values = ScatterParameters(parameters, order, static_cast<std::uint64_t>(s) + 1);
    EXPECT_TRUE(values) << values.error().message();
    draws.row(s) = Eigen::Map<const Eigen::RowVectorXd>(values->data(), draws.cols());
  }
  return draws;
}

double Mean(const Eigen::VectorXd& x) { return x.mean(); }

double StdDev(const Eigen::VectorXd& x) { return std::sqrt((x.array() - x.mean()).square().sum() / (kSeeds - 1)); }

double Correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  return ((x.array() - x.mean()) * (y.array() - y.mean())).mean() / (StdDev(x) * StdDev(y));
}

/// The share of x within `width` of `center`.
double ShareWithin(double width, double center, const Eigen::VectorXd& x) {
  return ((x.array() - center).abs() < width).cast<double>().mean();
}

TEST(ScatterParameters, IsNormalAboutTheMeansWithTheStandardDeviations) {
  const Eigen::MatrixXd draws = Draws({{kReleaseAngle, -0.4, 0.05}, {kInertia, 0.08, 0.001}});
  const auto check = [](const Eigen::VectorXd& x, double mean, double std_dev) {
    EXPECT_THAT(Mean(x), DoubleNear(mean, kTolerance * std_dev / kRootOfSeeds));
    EXPECT_THAT(StdDev(x), DoubleNear(std_dev, kTolerance * std_dev / (kRootOfSeeds * std::numbers::sqrt2)));
    // The shares of a normal distribution within one and two standard deviations.
    EXPECT_THAT(ShareWithin(std_dev, mean, x), DoubleNear(0.6827, kTolerance * 0.4654 / kRootOfSeeds));
    EXPECT_THAT(ShareWithin(2 * std_dev, mean, x), DoubleNear(0.9545, kTolerance * 0.2084 / kRootOfSeeds));
  };
  check(draws.col(0), -0.4, 0.05);
  check(draws.col(1), 0.08, 0.001);
}

TEST(ScatterParameters, DrawsParametersAndSeedsIndependently) {
  const Eigen::MatrixXd draws = Draws({{kReleaseAngle, 0, 1}, {kZeroAngle, 0, 1}});
  EXPECT_THAT(Correlation(draws.col(0), draws.col(1)), DoubleNear(0, kTolerance / kRootOfSeeds));
  Eigen::VectorXd next(kSeeds);
  next << draws.col(0).tail(kSeeds - 1), draws(0, 0);
  EXPECT_THAT(Correlation(draws.col(0), next), DoubleNear(0, kTolerance / kRootOfSeeds));
}

TEST(ScatterParameters, IsIndependentOfTheNoiseOfTheSameSeed) {
  SyntheticOptions options;
  options.model = {"linear", "viscous", Gravity::kLinear};
  options.parameters = {0.04, 0.002};
  options.start = StartKind::kMoving;
  options.initial_angle = 0.3;
  options.duration = 0.1;
  options.noise = 1;
  Eigen::MatrixXd noise(kSeeds, 2);
  for (int s = 0; s < kSeeds; ++s) {
    options.seed = static_cast<std::uint64_t>(s) + 1;
    noise.row(s) = SimulateRecording(options)->value.head(2).transpose();
  }
  const Eigen::MatrixXd draws = Draws({{kReleaseAngle, 0, 1}, {kZeroAngle, 0, 1}});
  for (const auto& [k, i] : {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
    EXPECT_THAT(Correlation(draws.col(k), noise.col(i)), DoubleNear(0, kTolerance / kRootOfSeeds));
  }
}

TEST(ScatterParameters, IsHalfNormalAboveABoundAtTheMean) {
  const Eigen::VectorXd x = Draws({{kBounded, 0, 2}}).col(0);
  EXPECT_GE(x.minCoeff(), 0);
  // The half-normal distribution: mean σ √(2/π), variance σ² (1 - 2/π).
  const double std_dev = 2 * std::sqrt(1 - 2 / std::numbers::pi);
  EXPECT_THAT(Mean(x), DoubleNear(2 * std::sqrt(2 / std::numbers::pi), kTolerance * std_dev / kRootOfSeeds));
  EXPECT_THAT(StdDev(x), DoubleNear(std_dev, kTolerance * std_dev / kRootOfSeeds));
}

TEST(ScatterParameters, RespectsTheOrderOfTwoParameters) {
  const Eigen::MatrixXd draws = Draws({{kBounded, 10, 0.5}, {kBounded, 10, 0.5}}, {.larger = 1, .smaller = 0});
  const Eigen::VectorXd difference = draws.col(1) - draws.col(0);
  EXPECT_GE(difference.minCoeff(), 0);
  // The difference of two independent normal variables is normal. Truncated at 0 it is half-normal with mean 2 σ / √π.
  EXPECT_THAT(Mean(difference), DoubleNear(2 * 0.5 / std::sqrt(std::numbers::pi), kTolerance * 0.5 / kRootOfSeeds));
}

TEST(ScatterParameters, GivesTheMeanWithoutScatterAndIsReproducible) {
  const std::vector<ScatteredParameter> parameters = {{kInertia, 0.079, 0}, {kReleaseAngle, 0.4, 0.1}};
  const auto once = ScatterParameters(parameters, {}, 7);
  const auto again = ScatterParameters(parameters, {}, 7);
  const auto other = ScatterParameters(parameters, {}, 7 + (1ULL << 32));  // all bits of a seed matter
  ASSERT_TRUE(once && again && other);
  EXPECT_EQ(*once, *again);
  EXPECT_EQ((*once)[0], 0.079);
  EXPECT_NE((*once)[1], (*other)[1]);
}

TEST(ScatterParameters, FailsIfNoDrawIsWithinTheBounds) {
  const auto message = [](const ScatteredParameter& parameter, OrderedPair order = {}) {
    const auto values = ScatterParameters(std::vector{parameter, {kBounded, 5, 0}}, order, 9);
    EXPECT_FALSE(values);
    EXPECT_EQ(values.error().code, StatusCode::kInvalidArgument);
    return values.error().message();
  };
  constexpr ParameterInfo kFraction{"fraction", "f", "", "", 0.0, 1.0, ""};
  EXPECT_THAT(message({kFraction, -1e6, 1}),
              AllOf(StartsWith("of 1000 draws with seed 9 none is within the bounds (in the last, fraction is -"),
                    EndsWith(", below 0); make the standard deviations smaller")));
  EXPECT_THAT(message({kFraction, 1e6, 1}), EndsWith(", above 1); make the standard deviations smaller"));
  EXPECT_THAT(message({kFraction, 0.5, 0}, {.larger = 0, .smaller = 1}),
              EndsWith("fraction is 0.5, below viscous, which is 5); make the standard deviations smaller"));
}

}  // namespace
}  // namespace pendulum::scatter_test
