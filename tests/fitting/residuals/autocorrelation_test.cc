// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/autocorrelation.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/correlated_noise.h"

namespace pendulum::autocorrelation_test {
namespace {

using testing::DoubleNear;
using Kind = Autocorrelation::Kind;

// ---- Processes with their correlations from the textbook -----------------------------------------------------------

/// ρ as a function of the lag [s].
using Correlation = std::function<double(double)>;

struct Process {
  Autocorrelation model;
  Correlation correlation;
};

constexpr double kInterval = 0.01;

Process FirstOrder(double phi) {
  return {{.kind = Kind::kAutoregressive,
           .autoregressive = {phi},
           .innovation_variance = 1 - phi * phi,
           .interval = kInterval},
          [=](double step) { return std::pow(phi, std::round(step / kInterval)); }};
}

/// Correlations from the Yule-Walker equations, continued by their recursion.
Process ThirdOrder(double a, double b, double c) {
  const Eigen::Matrix3d equations{{1 - b, -c, 0}, {-a - c, 1, 0}, {-b, -a, 1}};
  const Eigen::Vector3d first = equations.inverse() * Eigen::Vector3d(a, b, c);
  std::vector<double> rho = {1, first[0], first[1], first[2]};
  for (std::size_t k = 4; k < 2000; ++k) rho.push_back(a * rho[k - 1] + b * rho[k - 2] + c * rho[k - 3]);
  return {{.kind = Kind::kAutoregressive,
           .autoregressive = {a, b, c},
           .innovation_variance = 1 - a * rho[1] - b * rho[2] - c * rho[3],
           .interval = kInterval},
          [=](double step) { return rho[static_cast<std::size_t>(std::round(step / kInterval))]; }};
}

/// Box & Jenkins, Time Series Analysis, section 3.4: ρ_1 = (1 + φθ)(φ + θ) / (1 + 2φθ + θ²), ρ_k = φ ρ_{k-1}.
Process MixedOrder(double phi, double theta) {
  const double power = 1 + 2 * phi * theta + theta * theta;
  return {{.kind = Kind::kMixed,
           .autoregressive = {phi},
           .moving_average = theta,
           .innovation_variance = (1 - phi * phi) / power,
           .interval = kInterval},
          [=](double step) {
            const double lag = std::round(step / kInterval);
            return lag == 0 ? 1 : (1 + phi * theta) * (phi + theta) / power * std::pow(phi, lag - 1);
          }};
}

Process Continuous(double decay_time, double white_share) {
  return {{Kind::kContinuous, {}, 0, 1, kInterval, decay_time, white_share},
          [=](double step) { return step == 0 ? 1 : (1 - white_share) * std::exp(-step / decay_time); }};
}

std::vector<Process> EvenProcesses() {
  return {FirstOrder(0.5),           FirstOrder(-0.7),        FirstOrder(0.98),
          ThirdOrder(1.2, -0.5, .2), ThirdOrder(0, 0, 0.6),   MixedOrder(0.9, -0.5),
          MixedOrder(-0.4, 0.8),     MixedOrder(0.95, -0.95), MixedOrder(0, -0.9)};
}

/// W' R W with an explicit matrix R.
Eigen::MatrixXd DenseSum(const Correlation& correlation, const Eigen::VectorXd& time, const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd dense(time.size(), time.size());
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    for (Eigen::Index j = 0; j < time.size(); ++j) dense(i, j) = correlation(std::abs(time[i] - time[j]));
  }
  return weights.transpose() * dense * weights;
}

void ExpectDenseSum(const Process& process, const Eigen::VectorXd& time) {
  Eigen::MatrixXd weights(time.size(), 4);
  weights << SwingColumns(time), FirstOrderNoise(time.size(), 0, 0, 1);
  weights.col(1) *= 1e6;  // columns of very different size must not affect each other
  const Eigen::MatrixXd expected = DenseSum(process.correlation, time, weights);
  const Eigen::MatrixXd sum = CorrelatedSum(process.model, time, weights);
  const Eigen::VectorXd scale = expected.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      // Rounding of 700² products, and innovations whose share of 1e-24 is neglected.
      EXPECT_THAT(sum(i, j) / (scale[i] * scale[j]), DoubleNear(expected(i, j) / (scale[i] * scale[j]), 1e-9))
          << process.model.Name() << ": " << i << ", " << j;
    }
  }
}

// ---- CorrelatedSum -------------------------------------------------------------------------------------------------

TEST(CorrelatedSum, MatchesTheFullCorrelationMatrix) {
  for (const Process& process : EvenProcesses()) ExpectDenseSum(process, EvenTimes(700));
}

TEST(CorrelatedSum, BridgesShortAndLongGapsByWholeIntervals) {
  Eigen::VectorXd time = EvenTimes(600);
  time.tail(500).array() += 0.01;
  time.tail(350).array() += 0.13;
  time.tail(200).array() += 7.0;
  for (const Process& process : EvenProcesses()) ExpectDenseSum(process, time);
  for (const Process& process : EvenProcesses()) ExpectDenseSum(process, WithSomeMissing(EvenTimes(800), 0.2, 1));
}

TEST(CorrelatedSum, TreatsDistantPartsAsIndependent) {
  const Process process = FirstOrder(0.98);
  Eigen::VectorXd time = EvenTimes(600);
  time.tail(300).array() += 1e9;
  const Eigen::MatrixXd weights = SwingColumns(EvenTimes(600));
  const Eigen::MatrixXd apart = DenseSum(process.correlation, EvenTimes(300), weights.topRows(300)) +
                                DenseSum(process.correlation, EvenTimes(300), weights.bottomRows(300));
  EXPECT_THAT((CorrelatedSum(process.model, time, weights) - apart).norm() / apart.norm(), DoubleNear(0, 1e-9));
}

TEST(CorrelatedSum, TreatsJitterAsEvenSampling) {
  Eigen::VectorXd time = EvenTimes(300);
  const Eigen::MatrixXd weights = SwingColumns(time);
  const Process process = FirstOrder(0.9);
  const Eigen::MatrixXd expected = CorrelatedSum(process.model, time, weights);
  time.array() += 0.001 * (1000 * time.array()).sin();
  EXPECT_EQ(CorrelatedSum(process.model, time, weights), expected);
}

TEST(CorrelatedSum, AcceptsAnyTimeStampsForAContinuousProcess) {
  for (const double decay_time : {0.001, 0.1, 3.0, 1e4}) {
    for (const double white_share : {0.0, 0.4, 1.0}) {
      ExpectDenseSum(Continuous(decay_time, white_share), EventTimes(700, 3));
    }
  }
}

TEST(CorrelatedSum, IsTheInformationForWhiteResiduals) {
  const Eigen::MatrixXd weights = SwingColumns(EvenTimes(100));
  EXPECT_EQ(CorrelatedSum({}, EvenTimes(100), weights), weights.transpose() * weights);
}

TEST(CorrelatedSum, IsPositiveDefiniteForAVeryLongCorrelation) {
  const Eigen::MatrixXd sum = CorrelatedSum(FirstOrder(0.99999).model, EvenTimes(500), SwingColumns(EvenTimes(500)));
  EXPECT_THAT(sum(2, 2), DoubleNear(500.0 * 500, 500));  // all samples are nearly equal: R = 1 within 500 / 1e5
  EXPECT_GT(sum.determinant(), 0);
}

TEST(CorrelatedSum, AcceptsAMatrixWithoutColumns) {
  for (const Process& process : {FirstOrder(0.5), MixedOrder(0.5, 0.2), Continuous(0.1, 0)}) {
    EXPECT_EQ(CorrelatedSum(process.model, EvenTimes(50), Eigen::MatrixXd(50, 0)).size(), 0);
  }
}

// ---- Autocorrelation -----------------------------------------------------------------------------------------------

TEST(Autocorrelation, InflatesTheVarianceOfAMeanByTheSumOfItsCorrelations) {
  std::vector<Process> processes = EvenProcesses();
  processes.push_back(Continuous(0.1, 0.3));
  for (const Process& process : processes) {
    double expected = 1;
    for (int lag = 1; lag < 1900; ++lag) expected += 2 * process.correlation(lag * kInterval);
    EXPECT_THAT(process.model.VarianceInflation(), DoubleNear(expected, 1e-9)) << process.model.Name();
  }
  EXPECT_EQ(Autocorrelation().VarianceInflation(), 1);
}

TEST(Autocorrelation, IsNamedAsInTheLiterature) {
  EXPECT_EQ(Autocorrelation().Name(), "white");
  EXPECT_EQ(ThirdOrder(0.1, 0.1, 0.1).model.Name(), "AR(3)");
  EXPECT_EQ(MixedOrder(0.5, 0.1).model.Name(), "ARMA(1,1)");
  EXPECT_EQ(Continuous(1, 0).model.Name(), "continuous AR(1)");
  EXPECT_EQ(Continuous(1, 0.1).model.Name(), "continuous AR(1) + white");
}

}  // namespace
}  // namespace pendulum::autocorrelation_test
