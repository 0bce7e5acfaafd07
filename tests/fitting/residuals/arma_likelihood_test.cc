// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/arma_likelihood.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/correlated_residuals.h"

namespace pendulum::arma_likelihood_test {
namespace {

using testing::DoubleNear;
using testing::Ge;
using testing::Le;
using Kind = Autocorrelation::Kind;

Eigen::VectorXd WithGaps(Eigen::Index count) {
  Eigen::VectorXd time = EvenTimes(count);
  time.tail(count / 2).array() += 0.01;
  time.tail(count / 3).array() += 0.17;
  time.tail(count / 5).array() += 1.3;
  return time;
}

std::vector<Autocorrelation> EvenAutocorrelations() {
  return {Autoregressive({0.8}),
          Autoregressive({-0.6}),
          Autoregressive({1.5, -0.8}),
          Autoregressive({0, 0, 0.6}),
          Autoregressive({0.4, 0.1, -0.1, 0.2, 0.1, 0, -0.1, 0.1, 0.05, 0.2}),
          Mixed(0.9, -0.5),
          Mixed(0.3, 0.6)};
}

// ---- Tests ---------------------------------------------------------------------------------------------------------

/// Rounding error of 240 terms of some units each.
constexpr double kRounding = 1e-8;

void ExpectDense(const Autocorrelation& autocorrelation, double sigma, double rounding_variance,
                 const Eigen::VectorXd& time) {
  CorrelatedResiduals data = Drawn(autocorrelation, sigma, rounding_variance, time, 1);
  AddColumns(sigma * SwingColumns(time), &data);
  const auto found = MaximizeCorrelatedLikelihood(data, autocorrelation);
  ASSERT_TRUE(found) << autocorrelation.Name();
  EXPECT_EQ(found->autocorrelation.Name(), autocorrelation.Name());
  EXPECT_EQ(found->autocorrelation.interval, autocorrelation.interval);
  EXPECT_THAT(found->log_likelihood, DoubleNear(DenseLogLikelihood(data, *found), kRounding)) << autocorrelation.Name();
  const double truth = DenseLogLikelihood(data, autocorrelation, sigma, Eigen::Vector3d::Zero());
  EXPECT_THAT(found->log_likelihood, Ge(truth)) << autocorrelation.Name();
  // Twice the gain is about χ² with as many degrees of freedom as parameters: at most 15 here.
  EXPECT_THAT(found->log_likelihood, Le(truth + 20)) << autocorrelation.Name();
}

TEST(MaximizeCorrelatedLikelihood, MatchesTheDenseCovarianceMatrix) {
  for (const Autocorrelation& autocorrelation : EvenAutocorrelations()) {
    ExpectDense(autocorrelation, 2e-3, 0, EvenTimes(240));
    ExpectDense(autocorrelation, 2e-3, 1e-6, EvenTimes(240));
  }
}

TEST(MaximizeCorrelatedLikelihood, TreatsGapsAsMissingSamples) {
  for (const Autocorrelation& autocorrelation : EvenAutocorrelations()) {
    ExpectDense(autocorrelation, 2e-3, 0, WithGaps(240));
    ExpectDense(autocorrelation, 2e-3, 1e-6, WithGaps(240));
    ExpectDense(autocorrelation, 2e-3, 1e-6, WithSomeMissing(EvenTimes(300), 0.2, 1));
  }
}

TEST(MaximizeCorrelatedLikelihood, AcceptsAnyStampsForAContinuousProcess) {
  for (const double decay_time : {0.02, 0.3}) {
    for (const double white_share : {0.0, 0.3}) {
      ExpectDense(Continuous(decay_time, white_share), 2e-3, 0, EventTimes(240, 2));
      ExpectDense(Continuous(decay_time, white_share), 2e-3, 1e-6, EventTimes(240, 2));
    }
  }
}

TEST(MaximizeCorrelatedLikelihood, IsTheTextbookValueForWhiteResiduals) {
  CorrelatedResiduals data = Residuals(EvenTimes(4), Eigen::Vector4d(1, -2, 2, -1), 0.5);
  auto found = MaximizeCorrelatedLikelihood(data, {});
  ASSERT_TRUE(found);
  // Mean square 10 / 4, of which 0.5 is rounding: σ² = 2; log L = -N/2 (ln 2π 2.5 + 1).
  EXPECT_THAT(found->sigma, DoubleNear(std::sqrt(2.0), 1e-15));
  EXPECT_THAT(found->log_likelihood, DoubleNear(-2 * (std::log(2 * kPi * 2.5) + 1), 1e-14));
  EXPECT_EQ(found->parameters, 1);
  EXPECT_EQ(found->autocorrelation.Name(), "white");
  data.rounding_variance = 4;  // more than the total: σ = 0; log L = -N/2 ln 2π 4 - 10 / 8
  found = MaximizeCorrelatedLikelihood(data, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->sigma, 0);
  EXPECT_THAT(found->log_likelihood, DoubleNear(-2 * std::log(2 * kPi * 4) - 1.25, 1e-14));
}

TEST(MaximizeCorrelatedLikelihood, CountsParametersOfCorrelationAndScale) {
  const auto parameters = [](const Autocorrelation& like) {
    return MaximizeCorrelatedLikelihood(Drawn(like, 1, 0, EvenTimes(100), 1), like)->parameters;
  };
  EXPECT_EQ(parameters(Autoregressive({0.4, 0.1, 0.1})), 4);
  EXPECT_EQ(parameters(Mixed(0.5, 0.2)), 3);
  EXPECT_EQ(parameters(Continuous(0.1, 0)), 2);
  EXPECT_EQ(parameters(Continuous(0.1, 0.2)), 3);
}

/// Checks points about half a standard error (1 / sqrt(N) and more) from the maximum in several directions.
TEST(MaximizeCorrelatedLikelihood, IsAMaximum) {
  for (const Autocorrelation& autocorrelation : {Autoregressive({0.8}), Mixed(0.8, -0.3), Continuous(0.1, 0.2)}) {
    CorrelatedResiduals data = Drawn(autocorrelation, 1, 0.1, WithGaps(300), 3);
    AddColumns(SwingColumns(data.time), &data);
    const auto found = MaximizeCorrelatedLikelihood(data, autocorrelation);
    ASSERT_TRUE(found);
    for (const double side : {-1.0, 1.0}) {
      const auto lower = [&](const Autocorrelation& other, double sigma, const Eigen::VectorXd& shift) {
        EXPECT_LT(DenseLogLikelihood(data, other, sigma, shift), found->log_likelihood)
            << autocorrelation.Name() << side;
      };
      lower(found->autocorrelation, found->sigma * (1 + 0.05 * side), found->shift);
      for (int i = 0; i < 3; ++i) {
        lower(found->autocorrelation, found->sigma, found->shift + 0.05 * side * Eigen::Vector3d::Unit(i));
      }
      Autocorrelation other = found->autocorrelation;
      if (autocorrelation.kind == Kind::kContinuous) {
        other.decay_time *= 1 + 0.1 * side;
        lower(other, found->sigma, found->shift);
        other = found->autocorrelation;
        other.white_share *= 1 + 0.1 * side;
      } else {
        other.autoregressive[0] += 0.03 * side;
      }
      lower(other, found->sigma, found->shift);
    }
  }
}

TEST(MaximizeCorrelatedLikelihood, DoesNotDependOnTheStart) {
  const Autocorrelation autocorrelation = Autoregressive({1.2, -0.5, 0.2});
  const CorrelatedResiduals data = Drawn(autocorrelation, 1, 0.1, EvenTimes(300), 4);
  const auto found = MaximizeCorrelatedLikelihood(data, autocorrelation);
  ASSERT_TRUE(found);
  for (const Autocorrelation& like :
       {Autoregressive({-0.5, 0.3, 0.1}), Autoregressive({0, 0, 0.9}), Autoregressive({0, 0, 0})}) {
    const auto other = MaximizeCorrelatedLikelihood(data, like);
    ASSERT_TRUE(other);
    EXPECT_THAT(other->log_likelihood, DoubleNear(found->log_likelihood, 1e-6));
  }
}

TEST(MaximizeCorrelatedLikelihood, RespectsBounds) {
  const Autocorrelation autocorrelation = Autoregressive({0.7});
  CorrelatedResiduals data = Drawn(autocorrelation, 1, 0, EvenTimes(400), 5);
  const Eigen::MatrixXd columns = SwingColumns(data.time);
  AddColumns(columns, &data);
  data.residual += columns.col(0);
  data.lowest[0] = -0.1;
  data.highest[0] = 0.3;
  data.lowest[1] = data.highest[1] = 0;
  const auto bounded = MaximizeCorrelatedLikelihood(data, autocorrelation);
  data.residual -= 0.3 * columns.col(0);
  AddColumns(columns.rightCols(1), &data);
  const auto at_bound = MaximizeCorrelatedLikelihood(data, autocorrelation);
  ASSERT_TRUE(bounded && at_bound);
  EXPECT_EQ(bounded->shift[0], 0.3);
  EXPECT_EQ(bounded->shift[1], 0);
  EXPECT_THAT(bounded->shift[2], DoubleNear(at_bound->shift[0], 1e-3));  // a hundredth of its error
  EXPECT_THAT(bounded->log_likelihood, DoubleNear(at_bound->log_likelihood, 2e-3));
}

TEST(MaximizeCorrelatedLikelihood, AcceptsLinearlyDependentColumns) {
  const Autocorrelation autocorrelation = Mixed(0.8, -0.3);
  CorrelatedResiduals data = Drawn(autocorrelation, 1, 0.1, EvenTimes(400), 6);
  const Eigen::MatrixXd columns = SwingColumns(data.time);
  AddColumns(columns, &data);
  const auto whole = MaximizeCorrelatedLikelihood(data, autocorrelation);
  Eigen::MatrixXd dependent(400, 5);
  dependent << columns, columns.col(0) - 1e3 * columns.col(2), Eigen::VectorXd::Zero(400);
  AddColumns(dependent, &data);
  const auto deficient = MaximizeCorrelatedLikelihood(data, autocorrelation);
  ASSERT_TRUE(whole && deficient);
  EXPECT_THAT(deficient->log_likelihood, DoubleNear(whole->log_likelihood, 1e-6));
  EXPECT_THAT((dependent * deficient->shift - columns * whole->shift).norm(), DoubleNear(0, 1e-6));
  EXPECT_EQ(deficient->shift[4], 0);
}

// ---- Degenerate data ------------------------------------------------------------------------------------------------

std::vector<Autocorrelation> AllKinds() {
  std::vector<Autocorrelation> kinds = EvenAutocorrelations();
  kinds.insert(kinds.end(), {{}, Continuous(0.1, 0), Continuous(0.1, 0.3)});
  return kinds;
}

TEST(MaximizeCorrelatedLikelihood, IsMissingForZeroResidualsWithoutRounding) {
  for (const Autocorrelation& autocorrelation : AllKinds()) {
    CorrelatedResiduals data = Residuals(EvenTimes(100), Eigen::VectorXd::Zero(100), 0);
    EXPECT_FALSE(MaximizeCorrelatedLikelihood(data, autocorrelation)) << autocorrelation.Name();
    data.rounding_variance = 1e-6;
    const auto rounded = MaximizeCorrelatedLikelihood(data, autocorrelation);
    ASSERT_TRUE(rounded) << autocorrelation.Name();
    // σ approaches 0 until the difference is negligible.
    EXPECT_THAT(rounded->log_likelihood, DoubleNear(-50 * std::log(2 * kPi * 1e-6), 1e-3)) << autocorrelation.Name();
  }
}

void ExpectNothingOrANumber(const CorrelatedResiduals& data, const Autocorrelation& autocorrelation) {
  const auto found = MaximizeCorrelatedLikelihood(data, autocorrelation);
  if (!found) return;
  EXPECT_TRUE(std::isfinite(found->log_likelihood) && std::isfinite(found->sigma)) << autocorrelation.Name();
  EXPECT_TRUE(found->shift.allFinite()) << autocorrelation.Name();
}

TEST(MaximizeCorrelatedLikelihood, IsMissingOrFiniteForFewSamples) {
  for (const Autocorrelation& autocorrelation : AllKinds()) {
    for (const Eigen::Index samples : {1, 2, 3, 5}) {
      for (const Eigen::VectorXd& residual :
           {NormalNumbers(samples, 7), Eigen::VectorXd(Eigen::VectorXd::Ones(samples))}) {
        for (const Eigen::Index columns : {0, 1, 3}) {
          CorrelatedResiduals data = Residuals(EvenTimes(samples), residual, 0);
          AddColumns(SwingColumns(data.time).leftCols(columns), &data);
          ExpectNothingOrANumber(data, autocorrelation);
          data.rounding_variance = 0.1;
          EXPECT_TRUE(MaximizeCorrelatedLikelihood(data, autocorrelation)) << autocorrelation.Name();
          ExpectNothingOrANumber(data, autocorrelation);
        }
      }
    }
  }
}

/// With noise, a filter with long autocorrelation converges slowly. A curve without noise has almost no innovations.
TEST(MaximizeCorrelatedLikelihood, IsAccurateForVeryLongCorrelations) {
  const Eigen::VectorXd time = EvenTimes(1200);
  for (const Autocorrelation& autocorrelation :
       {Autoregressive({0.995}), Autoregressive({1.98, -0.985}), Mixed(0.99, -0.9)}) {
    const CorrelatedResiduals data = Drawn(autocorrelation, 1, 0.2, time, 8);
    const auto found = MaximizeCorrelatedLikelihood(data, autocorrelation);
    ASSERT_TRUE(found) << autocorrelation.Name();
    EXPECT_THAT(found->log_likelihood, DoubleNear(DenseLogLikelihood(data, *found), kRounding))
        << autocorrelation.Name();
  }
  const CorrelatedResiduals curve = Residuals(time, SwingColumns(time).col(0), 0);
  for (const Autocorrelation& autocorrelation : AllKinds()) ExpectNothingOrANumber(curve, autocorrelation);
}

TEST(MaximizeCorrelatedLikelihood, IsMissingForNonFiniteDataOrWithoutAClock) {
  const Autocorrelation autocorrelation = Autoregressive({0.5});
  const CorrelatedResiduals sound = Drawn(autocorrelation, 1, 0, EvenTimes(50), 1);
  EXPECT_TRUE(MaximizeCorrelatedLikelihood(sound, autocorrelation));
  CorrelatedResiduals data = sound;
  data.residual[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(MaximizeCorrelatedLikelihood(data, autocorrelation));
  data = sound;
  data.rounding_variance = -1;
  EXPECT_FALSE(MaximizeCorrelatedLikelihood(data, autocorrelation));
  data = sound;
  data.jacobian.resize(49, 0);
  EXPECT_FALSE(MaximizeCorrelatedLikelihood(data, autocorrelation));
  Autocorrelation timeless = autocorrelation;
  timeless.interval = 0;
  EXPECT_FALSE(MaximizeCorrelatedLikelihood(sound, timeless));
}

}  // namespace
}  // namespace pendulum::arma_likelihood_test
