// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/residuals/residual_diagnostics.h"
#include "tests/fitting/correlated_noise.h"

namespace pendulum::estimate_autocorrelation_test {
namespace {

using testing::DoubleNear;

Autocorrelation Estimate(const Eigen::VectorXd& time, const Eigen::VectorXd& residual) {
  return EstimateAutocorrelation(time, residual, Eigen::MatrixXd(time.size(), 0));
}

/// Means over seeds.
struct Summary {
  double coefficient = 0;  // φ, or exp(-10 ms / τ)
  double next = 0;         // ρ of the next sample, 10 ms later
  double inflation = 0;
  std::map<std::string, int> names;
};

double NextCorrelation(const Autocorrelation& model) {
  switch (model.kind) {
    case Autocorrelation::Kind::kContinuous: return (1 - model.white_share) * std::exp(-0.01 / model.decay_time);
    case Autocorrelation::Kind::kMixed: {
      const double phi = model.autoregressive[0];
      const double theta = model.moving_average;
      return (1 + phi * theta) * (phi + theta) / (1 + 2 * phi * theta + theta * theta);
    }
    case Autocorrelation::Kind::kAutoregressive: return model.autoregressive[0];  // of order 1
    case Autocorrelation::Kind::kWhite: break;
  }
  return 0;
}

Summary Summarize(int seeds, const std::function<Autocorrelation(std::uint64_t)>& estimate) {
  Summary summary;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Autocorrelation model = estimate(static_cast<std::uint64_t>(seed));
    const bool continuous = model.kind == Autocorrelation::Kind::kContinuous;
    const double coefficient = model.autoregressive.empty() ? 0 : model.autoregressive[0];
    summary.coefficient += (continuous ? std::exp(-0.01 / model.decay_time) : coefficient) / seeds;
    summary.next += NextCorrelation(model) / seeds;
    summary.inflation += model.VarianceInflation() / seeds;
    ++summary.names[model.Name()];
  }
  return summary;
}

// ---- Order ---------------------------------------------------------------------------------------------------------

TEST(EstimateAutocorrelation, CallsWhiteResidualsWhite) {
  for (const Eigen::Index count : {100, 500, 2000}) {
    const Eigen::VectorXd time = EvenTimes(count);
    const Summary summary =
        Summarize(300, [&](std::uint64_t seed) { return Estimate(time, FirstOrderNoise(count, 0, 0, seed)); });
    EXPECT_GE(summary.names.at("white"), 285) << count;            // 95 %
    EXPECT_THAT(summary.inflation, DoubleNear(1, 0.03)) << count;  // standard errors hardly increase
  }
}

TEST(EstimateAutocorrelation, CallsWhiteResidualsWhiteAtAnyStamps) {
  const Summary missing = Summarize(300, [](std::uint64_t seed) {
    const Eigen::VectorXd time = WithSomeMissing(EvenTimes(1000), 0.1, seed);
    return Estimate(time, CorrelatedNoise(time, 0, 0, seed));
  });
  EXPECT_GE(missing.names.at("white"), 285);
  const Summary events = Summarize(300, [](std::uint64_t seed) {
    const Eigen::VectorXd time = EventTimes(1000, seed);
    return Estimate(time, CorrelatedNoise(time, 0, 0, seed));
  });
  EXPECT_GE(events.names.at("white"), 285);
}

TEST(EstimateAutocorrelation, CallsFewOrNoResidualsWhite) {
  EXPECT_EQ(Estimate(EvenTimes(29), FirstOrderNoise(29, 0.98, 0, 1)).Name(), "white");
  EXPECT_EQ(Estimate(EvenTimes(500), Eigen::VectorXd::Zero(500)).Name(), "white");
  EXPECT_EQ(Estimate(EventTimes(500, 1), Eigen::VectorXd::Zero(500)).Name(), "white");
}

TEST(EstimateAutocorrelation, StaysStationaryForResidualsThatAreNotNoise) {
  const Eigen::VectorXd time = EvenTimes(500);
  const std::vector<Eigen::VectorXd> residuals = {Eigen::VectorXd::Ones(500), Eigen::VectorXd::Unit(500, 499),
                                                  Eigen::VectorXd::Unit(500, 0), time,
                                                  (4.8 * time.array()).sin().matrix()};
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    for (const Eigen::VectorXd& stamps : {time, EventTimes(500, 1)}) {
      const Autocorrelation model = EstimateAutocorrelation(stamps, residuals[i], SwingColumns(time));
      const Eigen::MatrixXd sum = CorrelatedSum(model, stamps, SwingColumns(time));
      EXPECT_TRUE(sum.allFinite()) << i;
      EXPECT_GT(sum.diagonal().minCoeff(), 0) << i;
    }
  }
}

TEST(EstimateAutocorrelation, FindsTheOrderOfAThirdOrderProcess) {
  const Summary summary = Summarize(100, [](std::uint64_t seed) {
    const Eigen::VectorXd innovation = FirstOrderNoise(3000, 0, 0, seed);
    Eigen::VectorXd value = innovation;
    for (Eigen::Index i = 3; i < 3000; ++i) {
      value[i] += 1.2 * value[i - 1] - 0.5 * value[i - 2] + 0.2 * value[i - 3];
    }
    return Estimate(EvenTimes(2800), value.tail(2800));
  });
  EXPECT_GE(summary.names.at("AR(3)"), 85);
  // By the Yule-Walker equations ρ = 0.90164, 0.76230, 0.66393, so σ_e² = 1 - Σφρ = 0.16639. The inflation is
  // σ_e² / (1 - Σφ)² = 0.16639 / 0.01; its estimate scatters by 15 %.
  EXPECT_THAT(summary.inflation, DoubleNear(16.64, 0.06 * 16.64));
}

// ---- Autocorrelation ------------------------------------------------------------------------------------------------

// Of AR(1) noise of a quarter count, rounded readings show the share 0.449 of the information, so 0.201 of its
// correlations; the sum of those of the noise is 2 φ/(1 - φ).
double InflationOfRounded(double phi) { return 1 + 0.201 * 2 * phi / (1 - phi); }

Autocorrelation EstimateOfRounded(double phi, Eigen::Index samples, std::uint64_t seed, Whiteness whiteness) {
  constexpr double kSigma = 0.25;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0, 1);
  Eigen::VectorXd time(samples), swing(samples), reading(samples);
  double noise = normal(generator);
  for (Eigen::Index i = 0; i < samples; ++i) {
    time[i] = 0.01 * static_cast<double>(i);
    swing[i] = 120 * std::cos(4.8 * time[i]);
    reading[i] = std::round(swing[i] + kSigma * noise);
    noise = phi * noise + std::sqrt(1 - phi * phi) * normal(generator);
  }
  NoiseModel model;
  model.family = NoiseFamily::kQuantized;
  model.sigma = kSigma;
  model.resolution = 1;
  return EstimateAutocorrelation(model, time, QuantileResiduals(model, reading, swing), Eigen::MatrixXd(samples, 0), {},
                                 whiteness);
}

TEST(EstimateAutocorrelation, FindsTheHiddenPartOfTheCorrelationOfRoundedNoise) {
  for (const double phi : {0.5, 0.8}) {
    SCOPED_TRACE(phi);
    const Summary summary =
        Summarize(40, [&](std::uint64_t seed) { return EstimateOfRounded(phi, 2000, seed, Whiteness::kPossible); });
    EXPECT_THAT(summary.inflation, DoubleNear(InflationOfRounded(phi), 0.1 * InflationOfRounded(phi)));
  }
}

// Of so few readings the criterion calls some white, although none are.
TEST(EstimateAutocorrelation, EstimatesTheSizeOfAnAutocorrelationThatIsKnownToBeThere) {
  constexpr double kPhi = 0.5;
  const auto summarize = [](Whiteness whiteness) {
    return Summarize(60, [&](std::uint64_t seed) { return EstimateOfRounded(kPhi, 600, seed, whiteness); });
  };
  EXPECT_GE(summarize(Whiteness::kPossible).names["white"], 3);
  const Summary known = summarize(Whiteness::kExcluded);
  EXPECT_THAT(known.names, testing::Not(testing::Contains(testing::Key("white"))));
  EXPECT_THAT(known.inflation, DoubleNear(InflationOfRounded(kPhi), 0.1 * InflationOfRounded(kPhi)));
}

TEST(EstimateAutocorrelation, IsNearlyWhiteOfWhiteResidualsThatMayNotBeWhite) {
  const Summary summary =
      Summarize(60, [&](std::uint64_t seed) { return EstimateOfRounded(0, 600, seed, Whiteness::kExcluded); });
  EXPECT_THAT(summary.inflation, DoubleNear(1, 0.05));
}

TEST(EstimateAutocorrelation, RecoversAFirstOrderProcess) {
  for (const double phi : {0.5, 0.9, 0.98}) {
    const Eigen::VectorXd time = EvenTimes(2000);
    const Summary summary =
        Summarize(60, [&](std::uint64_t seed) { return Estimate(time, FirstOrderNoise(2000, phi, 0, seed)); });
    EXPECT_GE(summary.names.at("AR(1)"), 57) << phi;
    // Bias -2φ/N, and four standard errors sqrt((1 - φ²) / N) of the mean of 60 (Brockwell & Davis, example 8.10.1).
    const double tolerance = 4 * std::sqrt((1 - phi * phi) / 2000 / 60);
    EXPECT_THAT(summary.coefficient, DoubleNear(phi * (1 - 2.0 / 2000), tolerance)) << phi;
  }
}

TEST(EstimateAutocorrelation, SeparatesWhiteNoiseFromAFirstOrderProcess) {
  const Eigen::VectorXd time = EvenTimes(2000);
  const Summary summary =
      Summarize(60, [&](std::uint64_t seed) { return Estimate(time, FirstOrderNoise(2000, 0.9, 0.5, seed)); });
  EXPECT_GE(summary.names.at("ARMA(1,1)"), 57);
  EXPECT_THAT(summary.coefficient, DoubleNear(0.9, 0.015));  // scatters by 0.018
  EXPECT_THAT(summary.next, DoubleNear(0.5 * 0.9, 0.02));    // scatters by 0.035
  EXPECT_THAT(summary.inflation, DoubleNear(10, 0.8));       // 1 + 2 · 0.5 · 9; scatters by 1.8
}

TEST(EstimateAutocorrelation, TreatsSeparatePartsIndependently) {
  // Three recordings in sequence, with a step of the level between them that no single process has.
  const Summary summary = Summarize(60, [](std::uint64_t seed) {
    Eigen::VectorXd time = EvenTimes(2100);
    Eigen::VectorXd noise(2100);
    for (Eigen::Index part = 0; part < 3; ++part) {
      time.segment(700 * part, 700).array() += 50.0 * static_cast<double>(part);
      noise.segment(700 * part, 700) = FirstOrderNoise(700, 0.9, 0, 3 * seed + static_cast<std::uint64_t>(part));
    }
    return Estimate(time, noise);
  });
  EXPECT_GE(summary.names.at("AR(1)"), 57);
  EXPECT_THAT(summary.coefficient, DoubleNear(0.9, 0.006));
}

TEST(EstimateAutocorrelation, HandlesGapsJitterAndUnevenStamps) {
  using Stamps = std::function<Eigen::VectorXd(std::uint64_t)>;
  const std::vector<std::pair<std::string, Stamps>> kinds = {
      {"1 % missing", [](std::uint64_t seed) { return WithSomeMissing(EvenTimes(2000), 0.01, seed); }},
      {"20 % missing", [](std::uint64_t seed) { return WithSomeMissing(EvenTimes(2500), 0.2, seed); }},
      {"jitter",
       [](std::uint64_t seed) -> Eigen::VectorXd {
         return EvenTimes(2000) + 0.0003 * FirstOrderNoise(2000, 0, 0, seed + 99);
       }},
      {"events", [](std::uint64_t seed) { return EventTimes(2000, seed); }}};
  for (const auto& kind : kinds) {
    const auto& name = kind.first;
    const auto& stamps = kind.second;
    for (const double white_share : {0.0, 0.4}) {
      const Summary summary = Summarize(40, [&](std::uint64_t seed) {
        const Eigen::VectorXd time = stamps(seed);
        return Estimate(time, CorrelatedNoise(time, 0.1, white_share, seed));
      });
      // Single estimates scatter by 0.013 and 0.035; the tolerances are four standard errors of the mean of 40.
      EXPECT_THAT(summary.coefficient, DoubleNear(std::exp(-0.1), 0.009)) << name << ", " << white_share;
      EXPECT_THAT(summary.next, DoubleNear((1 - white_share) * std::exp(-0.1), 0.025)) << name << ", " << white_share;
    }
  }
}

TEST(EstimateAutocorrelation, DoesNotDependOnTheScaleOfResidualsAndWeights) {
  const Eigen::VectorXd time = EvenTimes(500);
  for (const double white_share : {0.0, 0.4}) {
    const Eigen::VectorXd noise = FirstOrderNoise(500, 0.9, white_share, 4);
    const Autocorrelation one = EstimateAutocorrelation(time, noise, SwingColumns(time));
    const Autocorrelation other = EstimateAutocorrelation(time, 1e-6 * noise, 1e9 * SwingColumns(time));
    EXPECT_EQ(other.Name(), one.Name());
    EXPECT_THAT(other.autoregressive[0], DoubleNear(one.autoregressive[0], 1e-6));
  }
}

TEST(EstimateAutocorrelation, RestoresTheCorrelationRemovedByTheFit) {
  // 500 samples with an autocorrelation time of 50 samples. The three columns remove its slowest part, so φ appears
  // smaller.
  const Eigen::VectorXd time = EvenTimes(500);
  const Eigen::MatrixXd columns = SwingColumns(time);
  const auto residual = [&](std::uint64_t seed) -> Eigen::VectorXd {
    const Eigen::VectorXd noise = FirstOrderNoise(500, 0.98, 0, seed);
    return noise - columns * (columns.transpose() * columns).llt().solve(columns.transpose() * noise);
  };
  const Summary plain = Summarize(200, [&](std::uint64_t seed) { return Estimate(time, residual(seed)); });
  const Summary restricted =
      Summarize(200, [&](std::uint64_t seed) { return EstimateAutocorrelation(time, residual(seed), columns); });
  EXPECT_LT(plain.coefficient, 0.973);
  EXPECT_THAT(restricted.coefficient, DoubleNear(0.98, 0.007));
}

TEST(EstimateAutocorrelation, AcceptsLinearlyDependentColumns) {
  const Eigen::VectorXd time = EvenTimes(500);
  const Eigen::VectorXd noise = FirstOrderNoise(500, 0.9, 0, 2);
  Eigen::MatrixXd columns(500, 5);
  columns << SwingColumns(time), 2 * SwingColumns(time).col(1), Eigen::VectorXd::Zero(500);
  const double expected = EstimateAutocorrelation(time, noise, SwingColumns(time)).autoregressive[0];
  EXPECT_THAT(EstimateAutocorrelation(time, noise, columns).autoregressive[0], DoubleNear(expected, 1e-6));
}

}  // namespace
}  // namespace pendulum::estimate_autocorrelation_test
