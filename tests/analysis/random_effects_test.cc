// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/random_effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <boost/random/normal_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::random_effects_test {
namespace {

using Eigen::ArrayXd;
using Eigen::VectorXd;
using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::Gt;
using testing::Le;

struct Effects {
  VectorXd value, std_error;
};

VectorXd Five(const std::array<double, 5>& numbers) {
  VectorXd five(5);
  std::ranges::copy(numbers, five.begin());
  return five;
}

/// Five runs that scatter by about seven times their errors.
Effects Scattered() { return {Five({1.00, 1.07, 0.93, 1.12, 0.98}), Five({0.010, 0.012, 0.008, 0.020, 0.015})}; }

/// Five runs that differ by less than their errors: Q = 1.4 for 4 degrees of freedom.
Effects Agreeing() { return {Five({1.000, 1.011, 0.996, 1.009, 0.991}), Five({0.010, 0.012, 0.008, 0.020, 0.015})}; }

ArrayXd WeightsAt(const Effects& effects, double between_squared) {
  return (effects.std_error.array().square() + between_squared).inverse();
}

double MeanAt(const Effects& effects, double between_squared) {
  const ArrayXd weight = WeightsAt(effects, between_squared);
  return (weight * effects.value.array()).sum() / weight.sum();
}

/// Cochran's Q with weights 1 / (std_error² + between²).
double StatisticAt(const Effects& effects, double between_squared) {
  const double mean = MeanAt(effects, between_squared);
  return (WeightsAt(effects, between_squared) * (effects.value.array() - mean).square()).sum();
}

RandomEffects Summarize(const Effects& effects) { return SummarizeScatter(effects.value, effects.std_error); }

// ---- Defining equations --------------------------------------------------------------------------------------------

// Paule & Mandel (1982): Q equals its expectation, K - 1.
TEST(SummarizeScatter, SolvesTheEquationOfPauleAndMandel) {
  const RandomEffects effects = Summarize(Scattered());
  EXPECT_GT(effects.between, 0);
  const double squared = effects.between * effects.between;
  EXPECT_THAT(StatisticAt(Scattered(), squared), DoubleNear(4, 1e-8));
  EXPECT_THAT(effects.mean, DoubleNear(MeanAt(Scattered(), squared), 1e-12));
}

// Viechtbauer (2007): at the ends of the interval Q is the 97.5 % and the 2.5 % point of χ²(4), 11.143287 and 0.484419
// (from tables).
TEST(SummarizeScatter, HasAnIntervalFromChiSquare) {
  const RandomEffects effects = Summarize(Scattered());
  EXPECT_THAT(StatisticAt(Scattered(), std::pow(effects.between_lower95, 2)), DoubleNear(11.143287, 1e-5));
  EXPECT_THAT(StatisticAt(Scattered(), std::pow(effects.between_upper95, 2)), DoubleNear(0.484419, 1e-5));
  EXPECT_LT(effects.between_lower95, effects.between);
  EXPECT_GT(effects.between_upper95, effects.between);
}

// Hartung & Knapp (2001): at the Paule-Mandel estimate their factor Q / (K - 1) is 1; 2.776445 is Student's t(4) at
// 97.5 %.
TEST(SummarizeScatter, HasTheStandardErrorAndStudentsInterval) {
  const RandomEffects effects = Summarize(Scattered());
  const double error = 1 / std::sqrt(WeightsAt(Scattered(), effects.between * effects.between).sum());
  EXPECT_THAT(effects.std_error, DoubleNear(error, 1e-9));
  EXPECT_THAT(effects.lower95, DoubleNear(effects.mean - 2.776445 * error, 1e-7));
  EXPECT_THAT(effects.upper95, DoubleNear(effects.mean + 2.776445 * error, 1e-7));
}

TEST(SummarizeScatter, HasNoScatterForRunsThatAgree) {
  const RandomEffects effects = Summarize(Agreeing());
  EXPECT_EQ(effects.between, 0);
  EXPECT_EQ(effects.between_lower95, 0);
  EXPECT_GT(effects.between_upper95, 0);
  EXPECT_THAT(effects.mean, DoubleNear(MeanAt(Agreeing(), 0), 1e-14));
  EXPECT_THAT(effects.std_error, DoubleNear(1 / std::sqrt(WeightsAt(Agreeing(), 0).sum()), 1e-14));
}

// Runs that agree to the last digit still have errors: 0.01 / √3, without any scatter.
TEST(SummarizeScatter, HasAnErrorForEqualValues) {
  const RandomEffects effects = SummarizeScatter(VectorXd::Constant(3, 2.5), VectorXd::Constant(3, 0.01));
  EXPECT_DOUBLE_EQ(effects.mean, 2.5);
  EXPECT_THAT(effects.std_error, DoubleNear(0.01 / std::sqrt(3.0), 1e-15));
  EXPECT_EQ(effects.between, 0);
  EXPECT_TRUE(std::isnan(effects.between_upper95));  // the values are too close together to determine it
}

// Two runs with errors s at a distance d: Q = (d² / 2) / (s² + between²) = 1, so between² = d²/2 - s².
TEST(SummarizeScatter, FollowsFromTheDistanceOfTwoRuns) {
  const RandomEffects effects = SummarizeScatter(Eigen::Vector2d(1, 1.3), Eigen::Vector2d(0.1, 0.1));
  EXPECT_THAT(effects.between * effects.between, DoubleNear(0.09 / 2 - 0.01, 1e-10));
  EXPECT_THAT(effects.mean, DoubleNear(1.15, 1e-14));
  EXPECT_THAT(effects.std_error, DoubleNear(0.15, 1e-9));  // error of the mean of two values: half their distance
}

// With scatter far above the errors all runs have equal weight: the mean, and the standard deviation over √K.
TEST(SummarizeScatter, GivesThePlainMeanForLargeScatter) {
  Effects runs = Scattered();
  runs.std_error *= 1e-4;
  const RandomEffects effects = Summarize(runs);
  const double deviation = std::sqrt((runs.value.array() - runs.value.mean()).square().sum() / 4);
  EXPECT_THAT(effects.mean, DoubleNear(runs.value.mean(), 1e-7));
  EXPECT_THAT(effects.between, DoubleNear(deviation, 1e-6));
  EXPECT_THAT(effects.std_error, DoubleNear(deviation / std::sqrt(5.0), 1e-6));
}

// ---- Invariance ----------------------------------------------------------------------------------------------------

void ExpectMapped(const RandomEffects& mapped, const RandomEffects& plain, double shift, double scale) {
  const double allowed = 1e-9 * scale;
  EXPECT_THAT(mapped.mean, DoubleNear(shift + scale * plain.mean, allowed));
  EXPECT_THAT(mapped.std_error, DoubleNear(scale * plain.std_error, allowed));
  EXPECT_THAT(mapped.lower95, DoubleNear(shift + scale * plain.lower95, allowed));
  EXPECT_THAT(mapped.upper95, DoubleNear(shift + scale * plain.upper95, allowed));
  EXPECT_THAT(mapped.between, DoubleNear(scale * plain.between, allowed));
  EXPECT_THAT(mapped.between_lower95, DoubleNear(scale * plain.between_lower95, allowed));
  EXPECT_THAT(mapped.between_upper95, DoubleNear(scale * plain.between_upper95, allowed));
}

TEST(SummarizeScatter, FollowsShiftsAndUnits) {
  for (const Effects& runs : {Scattered(), Agreeing()}) {
    const RandomEffects plain = Summarize(runs);
    for (const double scale : {1e-6, 1.0, 1e6}) {
      for (const double shift : {0.0, -3 * scale, 20 * scale}) {
        SCOPED_TRACE(testing::Message() << scale << ", " << shift);
        const VectorXd value = (shift + scale * runs.value.array()).matrix();
        ExpectMapped(SummarizeScatter(value, scale * runs.std_error), plain, shift, scale);
      }
    }
  }
}

TEST(SummarizeScatter, DoesNotDependOnTheOrderOfRuns) {
  const Effects runs = Scattered();
  const RandomEffects reversed = SummarizeScatter(runs.value.reverse(), runs.std_error.reverse());
  ExpectMapped(reversed, Summarize(runs), 0, 1);
}

// ---- Published data ------------------------------------------------------------------------------------------------

/// 13 trials of the BCG vaccine: vaccinated people with and without tuberculosis, then the same for the control group
/// (G. A. Colditz et al., J. Am. Med. Assoc. 271:698, 1994; dat.bcg of W. Viechtbauer's metafor).
constexpr std::array<std::array<double, 4>, 13> kVaccine = {{{4, 119, 11, 128},
                                                             {6, 300, 29, 274},
                                                             {3, 228, 11, 209},
                                                             {62, 13536, 248, 12619},
                                                             {33, 5036, 47, 5761},
                                                             {180, 1361, 372, 1079},
                                                             {8, 2537, 10, 619},
                                                             {505, 87886, 499, 87892},
                                                             {29, 7470, 45, 7232},
                                                             {17, 1699, 65, 1600},
                                                             {186, 50448, 141, 27197},
                                                             {5, 2493, 3, 2338},
                                                             {27, 16886, 29, 17825}}};

/// Logarithms of the risk ratios and their standard errors.
Effects LogRiskRatios() {
  Effects effects{VectorXd(13), VectorXd(13)};
  for (Eigen::Index i = 0; i < 13; ++i) {
    const auto [a, b, c, d] = kVaccine[static_cast<std::size_t>(i)];
    effects.value[i] = std::log(a / (a + b) / (c / (c + d)));
    effects.std_error[i] = std::sqrt(1 / a - 1 / (a + b) + 1 / c - 1 / (c + d));
  }
  return effects;
}

/// Logarithms of the odds ratios and their standard errors.
Effects LogOddsRatios() {
  Effects effects{VectorXd(13), VectorXd(13)};
  for (Eigen::Index i = 0; i < 13; ++i) {
    const auto [a, b, c, d] = kVaccine[static_cast<std::size_t>(i)];
    effects.value[i] = std::log(a * d / (b * c));
    effects.std_error[i] = std::sqrt(1 / a + 1 / b + 1 / c + 1 / d);
  }
  return effects;
}

// Paule-Mandel's τ² of the log risk ratios is 0.318 (gradmeta.com/metovix-validation-report.html: 0.3180).
TEST(SummarizeScatter, HasThePublishedScatterOfTheVaccineTrials) {
  const RandomEffects effects = Summarize(LogRiskRatios());
  EXPECT_THAT(effects.between * effects.between, DoubleNear(0.3180, 2e-4));
}

// Log odds ratios, Q-profile interval 0.1302 to 1.1812 (metafor-project.org, analyses:vanhouwelingen2002).
TEST(SummarizeScatter, HasThePublishedIntervalOfTheVaccineTrials) {
  const RandomEffects effects = Summarize(LogOddsRatios());
  EXPECT_THAT(std::pow(effects.between_lower95, 2), DoubleNear(0.1302, 1e-4));
  EXPECT_THAT(std::pow(effects.between_upper95, 2), DoubleNear(1.1812, 1e-4));
}

// ---- Coverage ------------------------------------------------------------------------------------------------------

struct Coverage {
  double mean = 0, between = 0;  // shares of intervals that contain the true value
};

Coverage CoverageOf(const VectorXd& std_error, double between, int draws) {
  std::mt19937_64 generator(20260301);
  boost::random::normal_distribution<double> normal;
  Coverage covered;
  for (int draw = 0; draw < draws; ++draw) {
    VectorXd value(std_error.size());
    for (Eigen::Index k = 0; k < value.size(); ++k) {
      value[k] = 7 + std::hypot(between, std_error[k]) * normal(generator);
    }
    const RandomEffects effects = SummarizeScatter(value, std_error);
    covered.mean += effects.lower95 <= 7 && 7 <= effects.upper95 ? 1 : 0;
    covered.between += effects.between_lower95 <= between && between <= effects.between_upper95 ? 1 : 0;
  }
  return {covered.mean / draws, covered.between / draws};
}

const VectorXd kEqualErrors = VectorXd::Constant(5, 1.0);
const VectorXd kUnequalErrors = Five({0.6, 0.8, 1.0, 1.3, 2.0});

TEST(SummarizeScatter, CoversTheMeanOfScatteredRuns) {
  for (const VectorXd& errors : {kEqualErrors, kUnequalErrors}) {
    for (const double between : {1.0, 5.0}) {
      SCOPED_TRACE(between);
      EXPECT_THAT(CoverageOf(errors, between, 2000).mean, AllOf(Ge(0.93), Le(0.985)));
    }
  }
}

// The standard error is never below that of runs that agree, and the interval reaches 2.776 standard errors to either
// side (Student's t(4)). A normal mean is within 2.776 standard deviations in 99.45 of 100 draws, and in slightly more
// because the standard error is sometimes larger.
TEST(SummarizeScatter, CoversTheMeanTooOftenWithoutScatter) {
  for (const VectorXd& errors : {kEqualErrors, kUnequalErrors}) {
    EXPECT_THAT(CoverageOf(errors, 0, 2000).mean, AllOf(Ge(0.985), Le(0.9995)));
  }
}

// Q at the true value is χ²(4) for any errors. 2000 draws give 95 % ± 4 · 0.5 %. Without scatter the interval contains
// 0 unless Q is above the 97.5 % point.
TEST(SummarizeScatter, CoversTheScatterBetweenRuns) {
  for (const double between : {1.0, 5.0}) {
    EXPECT_THAT(CoverageOf(kUnequalErrors, between, 2000).between, DoubleNear(0.95, 0.02)) << between;
  }
  EXPECT_THAT(CoverageOf(kUnequalErrors, 0, 2000).between, AllOf(Gt(0.95), Le(0.99)));
}

// ---- Probability by chance -----------------------------------------------------------------------------------------

// χ² with two degrees of freedom exceeds x with probability exp(-x / 2); here x = 2 · 2.5².
TEST(ScatterP, HasAClosedFormForThreeValues) {
  const VectorXd value = Eigen::Vector3d(1 - 0.025, 1, 1 + 0.025), std_error = Eigen::Vector3d::Constant(0.01);
  EXPECT_THAT(ScatterP(value, std_error), DoubleNear(std::exp(-2.5 * 2.5), 1e-12));
}

TEST(ScatterP, IsNaNWithoutErrors) {
  const VectorXd value = Eigen::Vector3d(1, 2, 3);
  EXPECT_TRUE(std::isnan(ScatterP(value, Eigen::Vector3d(0.1, NAN, 0.1))));
  EXPECT_TRUE(std::isnan(ScatterP(value, Eigen::Vector3d(0.1, 0, 0.1))));
}

// ---- Scatter about a known centre ----------------------------------------------------------------------------------

// With equal errors K - 1 = Σ (value - centre)² / (error² + τ²) has a closed form.
TEST(ScatterAbout, HasAClosedFormForEqualErrors) {
  const VectorXd value = Five({1.00, 1.07, 0.93, 1.12, 0.98});
  const VectorXd std_error = VectorXd::Constant(5, 0.01);
  const double squares = (value.array() - 0.95).square().sum();
  EXPECT_THAT(ScatterAbout(0.95, value, std_error), DoubleNear(std::sqrt(squares / 4 - 1e-4), 1e-9));
}

TEST(ScatterAbout, IsZeroIfErrorsExplainAllScatter) {
  const Effects agreeing = Agreeing();
  EXPECT_EQ(ScatterAbout(1, agreeing.value, agreeing.std_error), 0);
  EXPECT_THAT(ScatterAbout(1.1, agreeing.value, agreeing.std_error), Gt(0.09));  // All values are 0.1 below the centre.
}

// The defining equation with unequal errors.
TEST(ScatterAbout, MakesTheStatisticEqualToItsDegreesOfFreedom) {
  const Effects effects = Scattered();
  const double about = ScatterAbout(1.05, effects.value, effects.std_error);
  const ArrayXd weight = WeightsAt(effects, about * about);
  EXPECT_THAT((weight * (effects.value.array() - 1.05).square()).sum(), DoubleNear(4, 1e-6));
}

}  // namespace
}  // namespace pendulum::random_effects_test
