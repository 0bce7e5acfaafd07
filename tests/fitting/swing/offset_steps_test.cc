// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/offset_steps.h"

#include <cmath>
#include <random>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::offset_steps_test {
namespace {

using Eigen::Index;
using testing::AllOf;
using testing::DoubleNear;
using testing::Gt;
using testing::IsEmpty;
using testing::Lt;
using testing::SizeIs;

constexpr double kPeriod = 1.0;  // s
constexpr double kRate = 100;    // Hz

/// 20 s of AR(1) noise with standard deviation 1 and the given lag-1 correlation, as residuals of a fit with the
/// parameters phase, amplitude and zero of a sine.
FitResiduals Noise(unsigned seed, double correlation = 0) {
  constexpr Index kCount = 2000;
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> draw;
  FitResiduals residuals;
  residuals.time = Eigen::ArrayXd::LinSpaced(kCount, 0, kCount - 1) / kRate;
  residuals.residual.resize(kCount);
  double before = draw(generator);
  for (double& value : residuals.residual) {
    value = before;
    before = correlation * before + std::sqrt(1 - correlation * correlation) * draw(generator);
  }
  const Eigen::ArrayXd phase = 2 * M_PI / kPeriod * residuals.time.array();
  residuals.rate = 100 * phase.cos();
  residuals.jacobian.resize(kCount, 3);
  residuals.jacobian << phase.sin(), phase.cos(), Eigen::ArrayXd::Ones(kCount);
  residuals.period = kPeriod;
  return residuals;
}

void AddStep(Index sample, double size, FitResiduals& residuals) {
  residuals.residual.tail(residuals.residual.size() - sample).array() += size;
}

TEST(FindOffsetSteps, FindsNoStepInNoise) {
  for (const double correlation : {0.0, 0.5, 0.95}) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      EXPECT_THAT(FindOffsetSteps(Noise(seed, correlation), 5), IsEmpty()) << seed << " at " << correlation;
    }
  }
}

// The difference of two means of n1 and n2 independent samples has the error sqrt(1 / n1 + 1 / n2).
TEST(FindOffsetSteps, EstimatesAStepAsWellAsTwoMeans) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    FitResiduals residuals = Noise(seed);
    AddStep(700, 0.75, residuals);
    const std::vector<OffsetStep> steps = FindOffsetSteps(residuals, 5);
    ASSERT_THAT(steps, SizeIs(1)) << seed;
    const double error = std::sqrt(1 / 700.0 + 1 / 1300.0);
    EXPECT_THAT(static_cast<double>(steps[0].sample), DoubleNear(700, 30)) << seed;
    EXPECT_THAT(steps[0].std_error, DoubleNear(error, 0.15 * error)) << seed;
    EXPECT_THAT(steps[0].size, DoubleNear(0.75, 4 * error)) << seed;
  }
}

TEST(FindOffsetSteps, FindsStepsOfBothSignsInTimeOrder) {
  FitResiduals residuals = Noise(3);
  AddStep(1500, 4, residuals);
  AddStep(300, -3, residuals);
  AddStep(900, 3, residuals);
  const std::vector<OffsetStep> steps = FindOffsetSteps(residuals, 10);
  ASSERT_THAT(steps, SizeIs(3));
  EXPECT_THAT(static_cast<double>(steps[0].sample), DoubleNear(300, 2));
  EXPECT_THAT(static_cast<double>(steps[1].sample), DoubleNear(900, 2));
  EXPECT_THAT(static_cast<double>(steps[2].sample), DoubleNear(1500, 2));
  EXPECT_THAT(steps[0].size, AllOf(Gt(-3.5), Lt(-2.5)));
}

// A law that does not describe the friction leaves residuals that oscillate with the swing, smooth from sample to
// sample.
TEST(FindOffsetSteps, FindsOnlyTheTrueStepInAMisfit) {
  FitResiduals residuals = Noise(4);
  residuals.residual *= 0.1;
  const Eigen::ArrayXd t = residuals.time.array();
  residuals.residual.array() += 3 * (t / 20 - 0.5) * (2 * M_PI * t + 0.3).sin();
  EXPECT_THAT(FindOffsetSteps(residuals, 5), IsEmpty());
  AddStep(1111, 2, residuals);
  const std::vector<OffsetStep> steps = FindOffsetSteps(residuals, 5);
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_EQ(steps[0].sample, 1111);
  EXPECT_THAT(steps[0].size, DoubleNear(2, 0.5));
}

TEST(FindOffsetSteps, DoesNotReportADriftASpikeOrAClockSlip) {
  FitResiduals drift = Noise(5);
  drift.residual.array() += 0.2 * drift.time.array() - 0.004 * drift.time.array().square();
  EXPECT_THAT(FindOffsetSteps(drift, 5), IsEmpty());
  FitResiduals spike = Noise(6);
  spike.residual.segment(1000, 2).array() += 30;
  EXPECT_THAT(FindOffsetSteps(spike, 5), IsEmpty());
  FitResiduals slipped = Noise(7);
  slipped.residual.tail(1000) += 0.02 * slipped.rate.tail(1000);
  EXPECT_THAT(FindOffsetSteps(slipped, 5), IsEmpty());
}

// A period of 20 s has 2000 samples; the search uses means over 20 samples.
TEST(FindOffsetSteps, LocatesAStepWithinItsBin) {
  FitResiduals residuals = Noise(9);
  residuals.period = 20;
  AddStep(1007, 5, residuals);
  const std::vector<OffsetStep> steps = FindOffsetSteps(residuals, 5);
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_THAT(static_cast<double>(steps[0].sample), DoubleNear(1007, 1));
}

TEST(FindOffsetSteps, StopsAtTheGivenNumberOfSteps) {
  FitResiduals residuals = Noise(8);
  for (Index sample = 200; sample < 2000; sample += 200) AddStep(sample, 10, residuals);
  EXPECT_THAT(FindOffsetSteps(residuals, 4), SizeIs(4));
}

}  // namespace
}  // namespace pendulum::offset_steps_test
