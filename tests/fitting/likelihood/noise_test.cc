// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/noise.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::noise_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- The probability of an interval --------------------------------------------------------------------------------

struct KnownInterval {
  double a, b;
  double log, lower, upper;
};

/// From mpmath, by erfc with 500 digits; densities below 1e-300 are 0.
std::vector<KnownInterval> KnownIntervals() {
  return {
      {0, 1, -1.07486232686207138, 1.16873713451363329, 0.708874905227206789},
      {0, kInfinity, -0.693147180559945309, 0.797884560802865356, 0},
      {-kInfinity, 0, -0.693147180559945309, 0, 0.797884560802865356},
      {-1, 1, -0.381715146302126072, 0.354437452613603394, 0.354437452613603394},
      {-9, 9, -2.2571768119076813e-19, 1.02797735716689148e-18, 1.02797735716689148e-18},
      {-0.001, 0.002, -6.72808202351855008, 333.333333333283326, 333.332833333658326},
      {-kInfinity, 1.5, -0.069143455612233983, 0, 0.138789750458850756},
      {-20, kInfinity, -2.7536241186062337e-89, 5.52094836215976319e-88, 0},
      {1, 2, -1.99579826918075538, 1.78043859560286566, 0.397269548971312908},
      {2, kInfinity, -3.78318433368203195, 2.37321553282284087, 0},
      {10, 11, -53.2313102255831249, 10.098346447538488, 0.000278072605468842719},
      {20, kInfinity, -203.917155371097264, 20.0497530685278505, 0},
      {25, 25.1, -316.724259418457175, 27.2572866469541985, 2.22625518634645916},
      {40, 41, -804.608442013753788, 40.0249688472072638, 1.03134623020747959e-16},
      {-kInfinity, -40, -804.608442013753788, 0, 40.0249688472072637},
      {1000, 1001, -500007.826694812184, 1000.00099999800001, 0},
      {1000, kInfinity, -500007.826694812184, 1000.00099999800001, 0},
      {0.5, 0.501, -7.95194396841596483, 1000.25018752083374, 999.749687562542077},
      {3, 3.001, -12.328193603728616, 1001.50091679161701, 998.500417041658631},
      {-0.75, -0.7498, -9.71730673035043696, 4999.625042707634, 5000.37494270513433},
      {1, 1.00005, -11.3224510860511853, 20000.5000124578979, 19999.4999874581063},
      {0, 1e-06, -14.7344490911691136, 1000000.00000016671, 999999.999999666712},
      {-2, -1.999999, -16.7344480912512136, 999999.000082766638, 1000001.00008226664},
      {2.5, 2.500000001, -24.7672042886607164, 999999918.509635848, 999999916.009635847},
      {9, 9.00005, -51.3226510777222506, 20004.5003458808812, 19995.5003208827562},
      {12, 12.00005, -82.8227260711597349, 20006.0006083811912, 19994.0005833836912},
      {30, 30.000000953674316, -464.781896449484371, 1048591.00007168452, 1048561.00007120769},
  };
}

/// Difference, relative to the expected value if that exceeds 1.
double AbsoluteOrRelative(double value, double expected) {
  return std::abs(value - expected) / std::max(std::abs(expected), 1.0);
}

double Relative(double value, double expected) {
  return expected == 0 ? std::abs(value) : std::abs(value / expected - 1);
}

TEST(GaussianInterval, MatchesFiveHundredDigitValues) {
  for (const KnownInterval& known : KnownIntervals()) {
    SCOPED_TRACE(std::to_string(known.a) + " to " + std::to_string(known.b));
    const IntervalProbability interval = GaussianInterval(known.a, known.b);
    EXPECT_LT(AbsoluteOrRelative(interval.log, known.log), 1e-13);
    EXPECT_LT(Relative(interval.lower, known.lower), 1e-11);
    EXPECT_LT(Relative(interval.upper, known.upper), 1e-11);
  }
}

TEST(GaussianInterval, IsSymmetric) {
  for (const KnownInterval& known : KnownIntervals()) {
    const IntervalProbability interval = GaussianInterval(known.a, known.b);
    const IntervalProbability mirrored = GaussianInterval(-known.b, -known.a);
    EXPECT_LT(AbsoluteOrRelative(mirrored.log, interval.log), 1e-15) << known.a;
    EXPECT_LT(Relative(mirrored.lower, interval.upper), 1e-14) << known.a;
    EXPECT_LT(Relative(mirrored.upper, interval.lower), 1e-14) << known.a;
  }
}

/// The log-probability and its slope are continuous where two formulas meet: ∂log/∂b = upper.
TEST(GaussianInterval, IsContinuousWhereFormulasMeet) {
  for (const double a : {-1.0, -1e-9, 0.0, 0.3, 9.0, 10.0, 11.0, 20.0, 40.0}) {
    for (double length = 1e-5; length < 2; length *= 1.01) {
      const double b = a + length;
      const double step = 1e-3 * length;
      const double slope = (GaussianInterval(a, b + step).log - GaussianInterval(a, b - step).log) / (2 * step);
      // The third derivative is at most 2 / length³, and log is accurate to 1e-13.
      const double allowed = 1e-6 / length + 1e-13 * (1 + a * a) / step;
      EXPECT_NEAR(GaussianInterval(a, b).upper, slope, allowed) << a << ", " << length;
    }
  }
}

// ---- Families ------------------------------------------------------------------------------------------------------

/// A noise model, a reading and a modelled value.
struct Case {
  std::string what;
  NoiseModel noise;
  double y = 0;
  double m = 0;
};

NoiseModel Noise(NoiseFamily family, double sigma, double resolution = 0) {
  NoiseModel noise;
  noise.family = family;
  noise.sigma = sigma;
  noise.resolution = resolution;
  return noise;
}

/// All families, with readings 0.2 to 6 σ away on both sides, and readings at both ends of a range. The corners of
/// Huber's function are left out.
std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const double z : {-6.0, -1.9, -1.2, -0.2, 0.3, 1.1, 2.5, 5.0}) {
    for (const double sigma : {0.05, 0.3, 1.0, 4.0}) {
      for (const auto family : {NoiseFamily::kGaussian, NoiseFamily::kHuber, NoiseFamily::kStudent}) {
        cases.push_back({std::string(NoiseFamilyName(family)), Noise(family, sigma), 0.7, 0.7 - z * sigma});
      }
      cases.push_back({"quantized", Noise(NoiseFamily::kQuantized, sigma, 1), 3, 3 - 0.4 - z * sigma});
      for (const auto family : {NoiseFamily::kGaussian, NoiseFamily::kQuantized}) {
        NoiseModel noise = Noise(family, sigma, 1);
        noise.low = -0.5;
        noise.high = 7.5;
        cases.push_back({"censored below", noise, -1, -0.5 + z * sigma});
        cases.push_back({"censored above", noise, 8, 7.5 + z * sigma});
      }
    }
  }
  return cases;
}

using Function = std::function<double(double)>;

/// f'(0) and f''(0) by five-point central differences, with an error of fourth order in the step.
double FirstDerivative(const Function& f, double h) { return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h); }

double SecondDerivative(const Function& f, double h) {
  return (16 * (f(h) + f(-h)) - (f(2 * h) + f(-2 * h)) - 30 * f(0)) / (12 * h * h);
}

/// l at m + σ u and with σ multiplied by e^v.
double LogAt(Case at, double u, double v) {
  at.m += u * at.noise.sigma;
  at.noise.sigma *= std::exp(v);
  return at.noise.LikelihoodAt(at.y, at.m).log;
}

// A step of 2e-3 has a truncation error of 1e-11. The rounding error is the error of l, some 1e-15, divided by the
// squared step.
constexpr double kStep = 2e-3;
constexpr double kRounding = 1e-8;

void ExpectDerivatives(const Case& at) {
  const NoiseLikelihood l = at.noise.LikelihoodAt(at.y, at.m);
  const double sigma = at.noise.sigma;
  const auto along_m = [&](double u) { return LogAt(at, u, 0); };
  const auto along_sigma = [&](double v) { return LogAt(at, 0, v); };
  const auto slope_in_sigma = [&](double v) {
    return FirstDerivative([&](double u) { return LogAt(at, u, v); }, kStep);
  };
  const double size = kRounding * (1 + std::abs(l.log));
  EXPECT_NEAR(l.score * sigma, FirstDerivative(along_m, kStep), size);
  EXPECT_NEAR(l.information * sigma * sigma, -SecondDerivative(along_m, kStep), size);
  EXPECT_NEAR(l.sigma_score, FirstDerivative(along_sigma, kStep), size);
  EXPECT_NEAR(l.sigma_information, -SecondDerivative(along_sigma, kStep), size);
  EXPECT_NEAR(l.mixed * sigma, -FirstDerivative(slope_in_sigma, kStep), size);
}

TEST(NoiseModel, HasTheDerivativesOfItsLogLikelihood) {
  for (const Case& at : Cases()) {
    SCOPED_TRACE(at.what + ", sigma " + std::to_string(at.noise.sigma) + ", m " + std::to_string(at.m));
    ExpectDerivatives(at);
  }
}

/// The maximum of l over m for a reading.
double BestLog(const Case& at) {
  const NoiseModel& noise = at.noise;
  if (noise.IsCensored(at.y)) return 0;
  if (noise.family != NoiseFamily::kQuantized) return noise.LikelihoodAt(at.y, at.y).log;
  return std::log(std::erf(0.5 * noise.resolution / noise.sigma / std::sqrt(2.0)));
}

TEST(NoiseModel, HasADevianceOfTwiceTheLogLikelihoodDifference) {
  for (const Case& at : Cases()) {
    SCOPED_TRACE(at.what + ", sigma " + std::to_string(at.noise.sigma) + ", m " + std::to_string(at.m));
    const NoiseLikelihood l = at.noise.LikelihoodAt(at.y, at.m);
    const SampleLikelihood sample = at.noise.DevianceAt(at.y, at.m);
    const double expected = 2 * (BestLog(at) - l.log);
    EXPECT_NEAR(sample.deviance, expected, 1e-13 * (1 + expected));
    EXPECT_NEAR(sample.score, l.score, 1e-13 * std::abs(l.score) + 1e-15);
    const double weight = at.noise.IsRobust() ? l.score / (at.y - at.m) : l.information;
    EXPECT_NEAR(sample.weight, weight, 1e-11 * weight + 1e-15);
  }
}

TEST(NoiseModel, HasNoDevianceIfTheModelMatchesTheReading) {
  for (const auto family :
       {NoiseFamily::kGaussian, NoiseFamily::kQuantized, NoiseFamily::kHuber, NoiseFamily::kStudent}) {
    const SampleLikelihood sample = Noise(family, 0.3, 1).DevianceAt(2, 2);
    EXPECT_NEAR(sample.deviance, 0, 1e-15) << NoiseFamilyName(family);
    EXPECT_NEAR(sample.score, 0, 1e-15) << NoiseFamilyName(family);
    EXPECT_GT(sample.weight, 0) << NoiseFamilyName(family);
  }
}

/// The integral, computed piecewise between corners.
double Integral(const Function& f, const std::vector<double>& corners) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  double sum = 0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) sum += Quadrature::integrate(f, corners[i], corners[i + 1]);
  return sum;
}

TEST(NoiseModel, HasUnitIntegralAndScoreVarianceEqualToTheInformation) {
  const double corner = NoiseModel::kHuberWidth;
  for (const auto family : {NoiseFamily::kGaussian, NoiseFamily::kHuber, NoiseFamily::kStudent}) {
    SCOPED_TRACE(std::string(NoiseFamilyName(family)));
    const NoiseModel noise = Noise(family, 1);
    // Integrates over z = x / (1 - |x|), which reaches infinity.
    const auto mean = [&](double NoiseLikelihood::*term, double NoiseLikelihood::*times) {
      return Integral(
          [&](double x) {
            const double stretch = 1 / (1 - std::abs(x));
            const NoiseLikelihood l = noise.LikelihoodAt(x * stretch, 0);
            return std::exp(l.log) * stretch * stretch * (term ? l.*term : 1.0) * (times ? l.*times : 1.0);
          },
          {-1 + 1e-12, -corner / (1 + corner), corner / (1 + corner), 1 - 1e-12});
    };
    using L = NoiseLikelihood;
    // The quadrature is accurate to the square root of machine epsilon.
    EXPECT_NEAR(mean(nullptr, nullptr), 1, 1e-8);
    EXPECT_NEAR(mean(&L::score, nullptr), 0, 1e-8);
    EXPECT_NEAR(mean(&L::sigma_score, nullptr), 0, 1e-8);
    EXPECT_NEAR(mean(&L::score, &L::score), mean(&L::information, nullptr), 1e-8);
    EXPECT_NEAR(mean(&L::sigma_score, &L::sigma_score), mean(&L::sigma_information, nullptr), 1e-8);
  }
}

TEST(NoiseModel, HasADistributionThatSumsItsProbabilities) {
  for (const Case& at : Cases()) {
    if (at.noise.family != NoiseFamily::kQuantized && !at.noise.IsCensored(at.y)) continue;
    const auto [below, up_to] = at.noise.DistributionAt(at.y, at.m);
    EXPECT_NEAR(up_to - below, std::exp(at.noise.LikelihoodAt(at.y, at.m).log), 1e-14) << at.what;
  }
  for (const auto family : {NoiseFamily::kGaussian, NoiseFamily::kStudent}) {
    const NoiseModel noise = Noise(family, 0.3);
    EXPECT_NEAR(noise.DistributionAt(2, 2).at, 0.5, 1e-15);
    const double slope = FirstDerivative([&](double x) { return noise.DistributionAt(2.4 + x, 2).at; }, 1e-3);
    EXPECT_NEAR(slope, std::exp(noise.LikelihoodAt(2.4, 2).log), 1e-9) << NoiseFamilyName(family);
  }
}

TEST(LogLikelihood, IsTheSumOverSamples) {
  const Eigen::Vector3d value(1, 2, 4);
  const Eigen::Vector3d readings(1.2, 1.9, 4.4);
  const double z2 = (0.04 + 0.01 + 0.16) / 0.25;
  const double expected = -0.5 * z2 - 3 * std::log(0.5 * std::sqrt(2 * std::acos(-1.0)));
  EXPECT_NEAR(LogLikelihood(Noise(NoiseFamily::kGaussian, 0.5), value, readings), expected, 1e-14);
}

TEST(NoiseModel, IntegratesTheDensityForRobustCensoredReadings) {
  for (const auto family : {NoiseFamily::kHuber, NoiseFamily::kStudent}) {
    NoiseModel open = Noise(family, 0.1);
    NoiseModel ended = open;
    ended.low = -1;
    ended.high = 1;
    for (const double m : {-1.3, -1.05, -0.9, 0.7, 0.95, 1.0, 1.1, 1.4}) {
      const auto density = [&](double y) { return std::exp(open.LikelihoodAt(y, m).log); };
      const double corner = 0.1 * NoiseModel::kHuberWidth;
      std::vector<double> above = {1.0};
      for (const double at : {m - corner, m + corner, m + 1, m + 10, m + 1000}) {
        if (at > 1.0) above.push_back(at);
      }
      EXPECT_NEAR(std::exp(ended.LikelihoodAt(1, m).log), Integral(density, above), 1e-8) << m;
      EXPECT_NEAR(std::exp(ended.LikelihoodAt(-1, -m).log), Integral(density, above), 1e-8) << m;
      EXPECT_NEAR(ended.DistributionAt(1, m).below, 1 - Integral(density, above), 1e-8) << m;
      EXPECT_EQ(ended.DistributionAt(1, m).at, 1);
    }
  }
}

TEST(NoiseModel, HasTheDerivativesOfRobustCensoredReadings) {
  constexpr double kSmall = 1e-5;
  for (const auto family : {NoiseFamily::kHuber, NoiseFamily::kStudent}) {
    NoiseModel noise = Noise(family, 0.1);
    noise.low = -1;
    noise.high = 1;
    for (const double y : {-1.0, 1.0}) {
      for (const double m : {-1.31, -1.05, -0.9, 0.72, 0.95, 1.02, 1.1}) {
        const auto log_at = [&](double at, double lambda) {
          NoiseModel other = noise;
          other.sigma *= std::exp(lambda);
          return other.LikelihoodAt(y, at).log;
        };
        const NoiseLikelihood l = noise.LikelihoodAt(y, m);
        const double up = log_at(m + kSmall, 0);
        const double down = log_at(m - kSmall, 0);
        EXPECT_NEAR(l.score, (up - down) / (2 * kSmall), 1e-5 * (1 + std::abs(l.score))) << y << " " << m;
        EXPECT_NEAR(l.information, -(up - 2 * l.log + down) / (kSmall * kSmall), 1e-2) << y << " " << m;
        const double wide = log_at(m, kSmall);
        const double narrow = log_at(m, -kSmall);
        EXPECT_NEAR(l.sigma_score, (wide - narrow) / (2 * kSmall), 1e-6) << y << " " << m;
        EXPECT_NEAR(l.sigma_information, -(wide - 2 * l.log + narrow) / (kSmall * kSmall), 1e-3) << y << " " << m;
        const double cross = log_at(m + kSmall, kSmall) - log_at(m + kSmall, -kSmall) - log_at(m - kSmall, kSmall) +
                             log_at(m - kSmall, -kSmall);
        EXPECT_NEAR(l.mixed, -cross / (4 * kSmall * kSmall), 1e-2) << y << " " << m;
      }
    }
  }
}

}  // namespace
}  // namespace pendulum::noise_test
