// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/cramer_rao.h"

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/reading_information.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::cramer_rao_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Eq;

/// A short swing: 300 samples at 50 Hz.
SyntheticOptions ShortRun(StartKind start = StartKind::kRelease) {
  SyntheticOptions run = start == StartKind::kRelease ? TextbookRun("coulomb") : MovingRun("coulomb");
  run.release_time = 0.907;
  run.duration = 6;
  run.sample_rate = 50;
  run.noise = 0.002;
  return run;
}

Eigen::VectorXd Times(const SyntheticOptions& run) { return Must(SimulateRecording(run)).time; }

std::vector<double> Bounds(const SyntheticOptions& run) {
  std::vector<double> bounds;
  for (const std::optional<double>& bound : CramerRaoBounds(run, Times(run))) bounds.push_back(bound.value_or(-1));
  return bounds;
}

/// Changes the parameter with this index in FitParameters' order.
SyntheticOptions Moved(SyntheticOptions run, std::size_t parameter, double step) {
  const bool released = run.start == StartKind::kRelease;
  std::vector<double*> places;
  for (double& value : run.parameters) places.push_back(&value);
  places.push_back(released ? &run.release_angle : &run.initial_angle);
  places.push_back(released ? &run.release_time : &run.initial_rate);
  places.push_back(&run.zero);
  *places[parameter] += step;
  return run;
}

/// N x P, by central differences of recordings without noise.
Eigen::MatrixXd JacobianByDifferences(SyntheticOptions run) {
  run.noise = run.resolution = 0;
  run.range.reset();
  const std::vector<double> truth = Truth(run);
  Eigen::MatrixXd jacobian(Times(run).size(), static_cast<Eigen::Index>(truth.size()));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double step = 1e-5 * std::abs(truth[i]);
    const Eigen::VectorXd right = Must(SimulateRecording(Moved(run, i, step))).value;
    const Eigen::VectorXd left = Must(SimulateRecording(Moved(run, i, -step))).value;
    jacobian.col(static_cast<Eigen::Index>(i)) = (right - left) / (2 * step);
  }
  return jacobian;
}

/// The bounds from JᵀR^-1J, R the N x N covariance of the noise.
std::vector<double> BoundsFromCovariance(const SyntheticOptions& run, const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd jacobian = JacobianByDifferences(run);
  const Eigen::MatrixXd information = jacobian.transpose() * covariance.llt().solve(jacobian);
  const Eigen::VectorXd bounds = information.fullPivLu().inverse().diagonal().cwiseSqrt();
  return {bounds.begin(), bounds.end()};
}

/// σ² r^|i - j|, plus `white` on the diagonal.
Eigen::MatrixXd Covariance(const SyntheticOptions& run, double white) {
  const Eigen::Index count = Times(run).size();
  Eigen::MatrixXd covariance(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const double power = run.noise_correlation == 0
                               ? (i == j ? 1.0 : 0.0)
                               : std::pow(run.noise_correlation, std::abs(static_cast<double>(i - j)));
      covariance(i, j) = run.noise * run.noise * power + (i == j ? white : 0.0);
    }
  }
  return covariance;
}

/// Ratios of bounds, for comparison with one tolerance.
std::vector<double> Ratios(const std::vector<double>& bounds, const std::vector<double>& expected) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < expected.size(); ++i) ratios.push_back(bounds.at(i) / expected[i]);
  return ratios;
}

// Differences with a step of 1e-5 are accurate to about 1e-4 where a reversal passes a sample.
constexpr double kDifferences = 1e-3;

TEST(CramerRaoBounds, AreTheInverseInformationForWhiteNoise) {
  for (const StartKind start : {StartKind::kRelease, StartKind::kMoving}) {
    const SyntheticOptions run = ShortRun(start);
    EXPECT_THAT(Ratios(Bounds(run), BoundsFromCovariance(run, Covariance(run, 0))), Each(DoubleNear(1, kDifferences)));
  }
}

TEST(CramerRaoBounds, MatchTheFullCovarianceForCorrelatedNoise) {
  for (const double correlation : {0.9, 0.5, -0.5}) {
    SyntheticOptions run = ShortRun();
    run.noise_correlation = correlation;
    EXPECT_THAT(Ratios(Bounds(run), BoundsFromCovariance(run, Covariance(run, 0))), Each(DoubleNear(1, kDifferences)));
    run.resolution = kCount;
    EXPECT_THAT(Ratios(Bounds(run), BoundsFromCovariance(run, Covariance(run, kCount * kCount / 12))),
                Each(DoubleNear(1, kDifferences)));
  }
}

// With noise of 1.5 counts or more, counts act as white noise of variance q²/12.
TEST(CramerRaoBounds, IncludeAVarianceOfATwelfthOfASquaredCount) {
  SyntheticOptions run = ShortRun();
  run.noise = 1.5 * kCount;
  const std::vector<double> fine = Bounds(run);
  run.resolution = kCount;
  EXPECT_THAT(Ratios(Bounds(run), fine), Each(DoubleNear(std::sqrt(1 + 1 / (12 * 1.5 * 1.5)), 1e-3)));
}

// Each sample contributes its ReadingInformation about (x, log σ), where x is the trajectory's reading.
TEST(CramerRaoBounds, TreatTheNoiseSizeAsUnknown) {
  SyntheticOptions run = ShortRun();
  run.noise = 0.15 * kCount;
  run.zero = 0.2 * kCount - run.release_angle;  // not in the middle of a count, so x and σ are correlated
  run.resolution = kCount;
  const Eigen::MatrixXd jacobian = JacobianByDifferences(run);
  SyntheticOptions clean = run;
  clean.noise = clean.resolution = 0;
  const Eigen::VectorXd readings = Must(SimulateRecording(clean)).value;
  const Eigen::Index size = jacobian.cols();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size + 1, size + 1);
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    Eigen::MatrixXd to_parameters = Eigen::MatrixXd::Zero(2, size + 1);
    to_parameters.row(0).head(size) = jacobian.row(i);
    to_parameters(1, size) = 1;
    information += to_parameters.transpose() * ReadingInformation(readings[i], run.noise, kCount, {}) * to_parameters;
  }
  const Eigen::VectorXd expected = information.fullPivLu().inverse().diagonal().cwiseSqrt().head(size);
  const Eigen::VectorXd known = information.topLeftCorner(size, size).fullPivLu().inverse().diagonal().cwiseSqrt();
  EXPECT_THAT(Ratios(Bounds(run), {expected.begin(), expected.end()}), Each(DoubleNear(1, kDifferences)));
  EXPECT_GT(Bounds(run)[3] / known[3], 1.01);  // effect of an unknown σ on the release angle
}

// A hold in the middle of a count shows only that count: the held angle is known only from the swing.
TEST(CramerRaoBounds, AreNotImprovedByAHoldInTheMiddleOfACount) {
  SyntheticOptions run = ShortRun();
  run.noise = 0.1 * kCount;
  run.zero = 0.01;
  run.release_angle = 120 * kCount - run.zero;
  run.resolution = kCount;
  const std::vector<double> middle = Bounds(run);
  run.release_time += 10;
  run.duration += 10;
  EXPECT_THAT(Ratios(Bounds(run), middle),
              Each(DoubleNear(1, 0.1)));  // the swing has equally many samples, at other phases
  SyntheticOptions edge = run;
  edge.release_angle += 0.5 * kCount;
  EXPECT_LT(Bounds(edge)[3], 0.5 * middle[3]);
}

// Readings that are cut off on one side contain less information, but still some.
TEST(CramerRaoBounds, GrowIfTheRangeCutsPeaks) {
  SyntheticOptions run = ShortRun();
  run.resolution = kCount;
  const std::vector<double> whole = Bounds(run);
  run.range = SensorRange{-80 * kCount, 943 * kCount};
  const std::vector<double> ratios = Ratios(Bounds(run), whole);
  EXPECT_THAT(ratios, Each(testing::AllOf(testing::Ge(1.0), testing::Le(3.0))));
  EXPECT_GT(ratios[0], 1.05);
}

TEST(CramerRaoBounds, ShrinkWithHeavyTailsOfTheSameScale) {
  SyntheticOptions run = ShortRun();
  const std::vector<double> gaussian = Bounds(run);
  run.noise_freedom = 3;
  // The tolerance is rounding, amplified by the inverse of the information.
  EXPECT_THAT(Ratios(Bounds(run), gaussian), Each(DoubleNear(std::sqrt(6.0 / 4.0), 1e-11)));
}

TEST(CramerRaoBounds, AreMissingWithoutAClosedForm) {
  const std::vector<std::function<void(SyntheticOptions&)>> spoilers = {
      [](SyntheticOptions& run) { run.noise = 0; },
      [](SyntheticOptions& run) {
        run.range = SensorRange{-1, 1};
      },
      [](SyntheticOptions& run) { (run.noise_freedom = 3, run.resolution = 0.01); },
      [](SyntheticOptions& run) { (run.noise_freedom = 3, run.noise_correlation = 0.5); },
      [](SyntheticOptions& run) {
        run.range = SensorRange{-1, 1};
        run.resolution = 0.01;
        run.noise_correlation = 0.5;
      },
  };
  for (const auto& spoil : spoilers) {
    SyntheticOptions run = ShortRun();
    spoil(run);
    EXPECT_THAT(Bounds(run), Each(Eq(-1)));
  }
}

TEST(CramerRaoBounds, AreMissingIfTheMotionCannotBeTraced) {
  SyntheticOptions run = ShortRun();
  const Eigen::VectorXd time = Times(run);
  run.parameters[2] = 1;  // friction holds the pendulum
  EXPECT_THAT(CramerRaoBounds(run, time), Each(Eq(std::nullopt)));
}

}  // namespace
}  // namespace pendulum::cramer_rao_test
