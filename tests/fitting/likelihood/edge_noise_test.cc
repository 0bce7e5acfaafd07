// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/edge_noise.h"

#include <cmath>
#include <random>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/encoder_edges.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::edge_noise_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;

constexpr double kResolution = 2 * kPi / 2400;  // rad

NoiseModel Edges(double sigma) {
  NoiseModel noise;
  noise.family = NoiseFamily::kEdges;
  noise.sigma = sigma;
  noise.resolution = kResolution;
  noise.edge = 0.5 * kResolution;
  return noise;
}

TEST(EdgeNoise, IsNormalAtAnEdgeAndAnIntervalInASilence) {
  const NoiseModel edges = Edges(2e-4);
  NoiseModel normal, levels = edges;
  normal.sigma = 2e-4;
  levels.family = NoiseFamily::kQuantized;
  levels.edge.reset();
  for (const double off : {-3e-4, 0.0, 1e-4, 1.4e-3}) {
    const double edge = 7.5 * kResolution, silence = -3 * kResolution;
    EXPECT_FALSE(edges.IsSilence(edge));
    EXPECT_TRUE(edges.IsSilence(silence));
    EXPECT_EQ(edges.LikelihoodAt(edge, edge + off).log, normal.LikelihoodAt(edge, edge + off).log);
    EXPECT_EQ(edges.DevianceAt(edge, edge + off).deviance, normal.DevianceAt(edge, edge + off).deviance);
    EXPECT_EQ(edges.LikelihoodAt(silence, silence + off).log, levels.LikelihoodAt(silence, silence + off).log);
    EXPECT_EQ(edges.DevianceAt(silence, silence + off).score, levels.DevianceAt(silence, silence + off).score);
    EXPECT_EQ(edges.DistributionAt(silence, silence + off).at, levels.DistributionAt(silence, silence + off).at);
  }
}

TEST(EdgeNoise, HasItsOwnSpreadForEachSample) {
  NoiseModel edges = Edges(2e-4);
  edges.spread = std::make_shared<const std::vector<double>>(std::vector<double>{1, 3});
  EXPECT_DOUBLE_EQ(edges.ForSample(1).sigma, 6e-4);
  EXPECT_DOUBLE_EQ(edges.Deviations(2)[1], 6e-4);
  EXPECT_DOUBLE_EQ(edges.From(1).ForSample(0).sigma, 6e-4);
}

/// Edges of 0.4 sin 5t with normal errors of the edges [rad] and of the time stamps [s].
struct Wave {
  Eigen::VectorXd time, value, readings;

  Wave(double edge, double stamp) {
    constexpr Eigen::Index kSize = 8000;
    time.setLinSpaced(kSize, 0, 12.0);
    readings = 0.4 * (5 * time.array()).sin();
    std::mt19937_64 generator(3);
    boost::random::normal_distribution<double> draw;
    value.resize(kSize);
    for (Eigen::Index i = 0; i < kSize; ++i)
      value[i] = readings[i] + edge * draw(generator) + stamp * 2 * std::cos(5 * time[i]) * draw(generator);
  }
};

TEST(EdgeNoise, SeparatesStampErrorsFromEdgeErrors) {
  NoiseModel noise = Edges(1);
  noise.edge.reset();  // every value is an edge
  for (const double stamp : {5e-5, 1e-4, 4e-4}) {
    const Wave wave(1e-4, stamp);
    // The error of each variance is some 4 % (2 / sqrt(N) and their correlation). The square root of their ratio has
    // the same error; four times that is allowed.
    EXPECT_THAT(
        MostLikelyStampRatio(noise, wave.value, wave.readings, RatesOf(wave.time, wave.readings)) / stamp * 1e-4,
        DoubleNear(1, 0.16))
        << stamp;
  }
  const Wave none(1e-4, 0);
  EXPECT_EQ(MostLikelyStampRatio(noise, none.value, none.readings, RatesOf(none.time, none.readings)), 0);
}

TEST(EdgeNoise, DoesNotAttributeASlowMisfitToTheStamps) {
  NoiseModel noise = Edges(1);
  noise.edge.reset();
  const Wave wave(1e-4, 0);
  const Eigen::VectorXd late = wave.readings.array() + 2e-3 * 2 * (5 * wave.time.array()).cos();  // by 2 ms
  EXPECT_LT(MostLikelyStampRatio(noise, wave.value, late, RatesOf(wave.time, late)), 0.5);
}

SyntheticOptions Encoder(std::uint64_t seed) {
  SyntheticOptions run;
  run.parameters = TextbookParameters(run.model);
  run.start = StartKind::kMoving;
  run.initial_angle = -0.2;
  run.initial_rate = 1.5;
  run.zero = 0.0123;
  run.duration = 12;
  run.sample_rate = 1000;
  run.rows = RowTiming::kEvents;
  run.resolution = kResolution;
  run.noise = 0.05 * kResolution;
  run.time_noise = 1e-4;
  run.seed = seed;
  return run;
}

TEST(EdgeNoise, IsEstimatedByAFit) {
  const SyntheticOptions run = Encoder(5);
  const Recording edges = WithEdges(Must(SimulateRecording(run)), {});
  ASSERT_TRUE(edges.edge);
  const FitReport fit = Must(FitRecording(edges, {}));
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_EQ(fit.noise.family, NoiseFamily::kEdges);
  EXPECT_THAT(fit.noise.sigma / run.noise, DoubleNear(1, 0.15));
  EXPECT_THAT(fit.noise.stamp_ratio * fit.noise.sigma / run.time_noise, DoubleNear(1, 0.15));
  const std::vector<double> truth = TrueParameters(run);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_TRUE(fit.parameters[i].std_error) << fit.parameters[i].info.name;
    EXPECT_THAT(fit.parameters[i].estimate, DoubleNear(truth[i], 4 * *fit.parameters[i].std_error))
        << fit.parameters[i].info.name;
  }
}

TEST(EdgeNoise, GivesSmallerErrorsFromEventsThanFromSamples) {
  constexpr int kRuns = 8;
  Eigen::Vector3d events = Eigen::Vector3d::Zero(), sampled = Eigen::Vector3d::Zero(), counts = events;
  for (int k = 0; k < kRuns; ++k) {
    SyntheticOptions run = Encoder(static_cast<std::uint64_t>(100 + k));
    run.zero += 1e-4 * k;
    run.time_noise = 0;
    const auto squares = [&](const Recording& recording, std::optional<NoiseFamily> noise) {
      FitOptions options;
      options.noise = noise;
      options.interval = IntervalMethod::kCovariance;
      const FitReport fit = Must(FitRecording(WithEdges(recording, options.noise), options));
      Eigen::Vector3d square;
      for (int i = 0; i < 3; ++i) square[i] = std::pow(fit.parameters[i].estimate / run.parameters[i] - 1, 2);
      return square;
    };
    const Recording ticks = Must(SimulateRecording(run));
    events += squares(ticks, std::nullopt);
    counts += squares(ticks, NoiseFamily::kGaussian);
    run.rows = RowTiming::kEvenFromEncoder;
    sampled += squares(Must(SimulateRecording(run)), std::nullopt);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(events[i], sampled[i]) << "inertia, viscous, coulomb: " << i;
    EXPECT_LE(events[i], 0.25 * counts[i]) << "rows taken for samples of counts: " << i;
  }
}

/// A lag of a third of a count, if ignored, would look like friction; the fit distinguishes them.
TEST(EdgeNoise, SeparatesTheLagOfEdgesFromFriction) {
  SyntheticOptions run = Encoder(7);
  run.hysteresis = 0.35 * kResolution;
  const Recording edges = WithEdges(Must(SimulateRecording(run)), {});
  const FitReport fit = Must(FitRecording(edges, {}));
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  const std::vector<double> truth = TrueParameters(run);
  ASSERT_EQ(fit.parameters.size(), truth.size());
  EXPECT_EQ(fit.parameters.back().info.name, "hysteresis");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_TRUE(fit.parameters[i].std_error) << fit.parameters[i].info.name;
    EXPECT_THAT(fit.parameters[i].estimate, DoubleNear(truth[i], 4 * *fit.parameters[i].std_error))
        << fit.parameters[i].info.name;
  }
  FitOptions blind;
  blind.fixed["hysteresis"] = 0;
  const FitReport without_lag = Must(FitRecording(edges, blind));
  EXPECT_GT(std::abs(without_lag.Find("coulomb")->estimate - truth[2]), 5 * *fit.Find("coulomb")->std_error);
}

TEST(RatesOf, AreFiniteForNearlyEqualStamps) {
  Eigen::VectorXd time(6), readings(6);
  time << 0, 1e-16, 0.1, 0.2, std::nextafter(0.2, 1.0), 0.3;
  readings << 0, 0.001, 0.2, 0.4, 0.401, 0.6;
  const Eigen::VectorXd rates = RatesOf(time, readings);
  for (const double rate : rates) EXPECT_THAT(rate, DoubleNear(2, 0.05));
}

/// An encoder records only one row during a hold.
TEST(EdgeNoise, FindsTheReleaseAfterAHoldOfOneRow) {
  SyntheticOptions run = Encoder(7);
  run.start = StartKind::kRelease;
  run.release_angle = 0.5;
  run.release_time = 0.4;
  run.duration = 25;
  run.resolution = 5 * 3.14159265358979 / 180;
  run.noise = 0.01 * run.resolution;
  const FitReport fit = Must(FitRecording(WithEdges(Must(SimulateRecording(run)), {}), {}));
  EXPECT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  EXPECT_EQ(fit.start, StartKind::kRelease);
  EXPECT_THAT(std::abs(fit.Find("hysteresis")->estimate), testing::Lt(4.5 * fit.Find("hysteresis")->std_error.value()));
  EXPECT_LT(fit.noise.sigma, 0.05 * run.resolution);
}

TEST(EdgeNoise, IsRefusedForRowsThatAreNotEvents) {
  SyntheticOptions run = Encoder(1);
  run.rows = RowTiming::kEvenFromEncoder;
  run.time_noise = 0;
  FitOptions options;
  options.noise = NoiseFamily::kEdges;
  const auto fit = FitRecording(WithEdges(Must(SimulateRecording(run)), options.noise), options);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(fit.error().message(), HasSubstr("--noise edges needs rows that exist only where the count changes"));
}

}  // namespace
}  // namespace pendulum::edge_noise_test
