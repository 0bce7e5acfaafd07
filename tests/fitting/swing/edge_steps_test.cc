// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/edge_steps.h"

#include <cmath>
#include <random>
#include <vector>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/encoder_edges.h"

namespace pendulum::edge_steps_test {
namespace {

using testing::DoubleNear;
using testing::SizeIs;

constexpr double kResolution = 0.003;  // rad

/// Edges of 0.3 cos 5t in sequence, with the residuals of a fit that ignores their lag and the counts lost at turning
/// points: `lost[k]` counts at turning point k.
struct Edges {
  Recording recording;
  FitResiduals residuals;

  Edges(double lag, double noise, const std::vector<int>& lost) {
    constexpr double kAmplitude = 0.3, kRate = 5;
    std::vector<double> time, value, residual;
    std::mt19937_64 generator(4);
    boost::random::normal_distribution<double> draw(0, noise);
    int counts = 0;
    for (std::size_t half = 0; half <= lost.size(); ++half) {
      if (half > 0) counts += lost[half - 1];
      const double direction = half % 2 == 0 ? -1 : 1;
      for (int edge = 99; edge >= -99; --edge) {
        const double level = -direction * (edge + 0.5) * kResolution;  // in the order of crossing
        if (std::abs(level) >= kAmplitude) continue;
        const double phase = std::acos(std::abs(level) / kAmplitude);
        const double from_turn = -direction * level > 0 ? phase : std::acos(-1.0) - phase;
        time.push_back((static_cast<double>(half) * std::acos(-1.0) + from_turn) / kRate);
        value.push_back(level + counts * kResolution);
        residual.push_back(counts * kResolution - direction * lag + draw(generator));
      }
    }
    const auto size = static_cast<Eigen::Index>(time.size());
    recording.time = residuals.time = Eigen::Map<const Eigen::VectorXd>(time.data(), size);
    recording.value = Eigen::Map<const Eigen::VectorXd>(value.data(), size);
    recording.resolution = kResolution;
    recording.edge = 0.5 * kResolution;
    residuals.residual = Eigen::Map<const Eigen::VectorXd>(residual.data(), size);
    residuals.jacobian.resize(size, 2);  // amplitude and zero
    residuals.jacobian << (kRate * residuals.time.array()).cos(), Eigen::ArrayXd::Ones(size);
    residuals.residual += 0.02 * residuals.jacobian.col(0);
    residuals.rate = -kAmplitude * kRate * (kRate * residuals.time.array()).sin();
    residuals.period = 2 * std::acos(-1.0) / kRate;
  }
};

TEST(FindEdgeSteps, FindsEachCountThatWasLostAtATurningPoint) {
  const Edges edges(0.4 * kResolution, 0.05 * kResolution, {0, 1, 0, 0, -1, 0, 1, 1, 0, 0, -4, 0, 0, 1, 0});
  const std::vector<OffsetStep> steps = FindEdgeSteps(edges.residuals, edges.recording);
  const std::vector<double> counts = {1, -1, 1, 1, -4, 1};
  const std::vector<double> half_swings = {2, 5, 7, 8, 11, 14};
  ASSERT_THAT(steps, SizeIs(counts.size()));
  for (std::size_t k = 0; k < steps.size(); ++k) {
    EXPECT_THAT(steps[k].size / kResolution, DoubleNear(counts[k], 1e-9));
    const double turn = half_swings[k] * std::acos(-1.0) / 5;  // the step is at the next edge
    EXPECT_THAT(edges.recording.time[steps[k].sample] - turn, DoubleNear(0.02, 0.02));
  }
}

TEST(FindEdgeSteps, FindsNothingIfNothingWasLost) {
  const Edges edges(0.4 * kResolution, 0.1 * kResolution, std::vector<int>(20, 0));
  EXPECT_THAT(FindEdgeSteps(edges.residuals, edges.recording), SizeIs(0));
}

TEST(FindEdgeSteps, KeepsTheSizeOfAStepThatIsNotWholeCounts) {
  Edges edges(0, 0.05 * kResolution, std::vector<int>(10, 0));
  edges.residuals.residual.tail(edges.recording.size() / 11 * 5).array() += 1.5 * kResolution;  // five half swings
  const std::vector<OffsetStep> steps = FindEdgeSteps(edges.residuals, edges.recording);
  ASSERT_FALSE(steps.empty());
  EXPECT_GT(std::abs(steps[0].size / kResolution - std::round(steps[0].size / kResolution)), 0.3);
}

}  // namespace
}  // namespace pendulum::edge_steps_test
