// SPDX-License-Identifier: Apache-2.0
// Properties of the likelihood of quantized readings that hold for any implementation. Averaged over all possible
// readings with their true probabilities, the scores have mean 0 and their variance is the information (R. A. Fisher,
// Phil. Trans. R. Soc. A 222:309, 1922). Also tests the likeliest σ.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/student_t_distribution.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum::noise_kernel_test {
namespace {

// ---- Identities of scores -------------------------------------------------------------------------------------------

/// Probability that a normal variable lies in [from, to], computed from the tail that contains the interval.
double Probability(const boost::math::normal& normal, double from, double to) {
  using boost::math::cdf;
  using boost::math::complement;
  if (from >= normal.mean()) return cdf(complement(normal, from)) - (std::isinf(to) ? 0 : cdf(complement(normal, to)));
  if (to <= normal.mean()) return cdf(normal, to) - (std::isinf(from) ? 0 : cdf(normal, from));
  const double below = std::isinf(from) ? 0 : cdf(normal, from);
  const double above = std::isinf(to) ? 0 : cdf(complement(normal, to));
  return 1 - below - above;
}

/// Means over the readings k of a sensor with levels 1 apart, between lowest and highest.
struct ScoreMeans {
  double probability = 0;
  double score = 0, score_size = 0, score_square = 0, information = 0;
  double sigma_score = 0, sigma_score_size = 0, sigma_score_square = 0, sigma_information = 0;
  double product = 0, mixed = 0;
};

ScoreMeans SumOver(double sigma, double truth, int lowest, int highest) {
  const boost::math::normal normal(truth, sigma);
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = sigma;
  noise.resolution = 1;
  noise.low = lowest + 0.5;
  noise.high = highest - 0.5;
  ScoreMeans sums;
  for (int k = lowest; k <= highest; ++k) {
    const double from = k == lowest ? -INFINITY : k - 0.5;
    const double to = k == highest ? INFINITY : k + 0.5;
    const double p = Probability(normal, from, to);
    const NoiseLikelihood l = noise.LikelihoodAt(k, truth);
    sums.probability += std::exp(l.log);
    sums.score += p * l.score;
    sums.score_size += p * std::abs(l.score);
    sums.score_square += p * l.score * l.score;
    sums.information += p * l.information;
    sums.sigma_score += p * l.sigma_score;
    sums.sigma_score_size += p * std::abs(l.sigma_score);
    sums.sigma_score_square += p * l.sigma_score * l.sigma_score;
    sums.sigma_information += p * l.sigma_information;
    sums.product += p * l.score * l.sigma_score;
    sums.mixed += p * l.mixed;
  }
  return sums;
}

void ExpectScoreIdentities(const ScoreMeans& sums) {
  EXPECT_NEAR(sums.probability, 1, 1e-12);
  EXPECT_LE(std::abs(sums.score), 1e-9 * sums.score_size);
  EXPECT_LE(std::abs(sums.sigma_score), 1e-9 * sums.sigma_score_size);
  EXPECT_NEAR(sums.score_square, sums.information, 1e-8 * sums.information);
  EXPECT_NEAR(sums.sigma_score_square, sums.sigma_information, 1e-8 * sums.sigma_information);
  EXPECT_NEAR(sums.product, sums.mixed, 1e-8 * std::sqrt(sums.information * sums.sigma_information));
}

/// For noise from a fiftieth of a level to five levels, and true values from the middle of a level to its edge.
void ForEachNoiseAndPhase(const std::function<void(double sigma, double phase)>& body) {
  for (const double sigma : {0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0}) {
    for (const double phase : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) {
      SCOPED_TRACE("sigma " + std::to_string(sigma) + ", phase " + std::to_string(phase));
      body(sigma, phase);
    }
  }
}

TEST(QuantizedLikelihood, HasScoreVarianceEqualToTheInformation) {
  ForEachNoiseAndPhase([](double sigma, double phase) {
    const int reach = static_cast<int>(std::ceil(12 * sigma)) + 2;  // 12 σ: the probability beyond is 1e-33
    ExpectScoreIdentities(SumOver(sigma, phase, -reach, reach));
  });
}

TEST(QuantizedLikelihood, HasScoreVarianceEqualToTheInformationNearAnEndOfTheRange) {
  ForEachNoiseAndPhase([](double sigma, double phase) {
    ExpectScoreIdentities(SumOver(sigma, phase, -1, 1));
    ExpectScoreIdentities(SumOver(sigma, phase, 0, 4));   // often at its lower end
    ExpectScoreIdentities(SumOver(sigma, phase, -7, 1));  // often at its upper end
  });
}

/// With a wrong σ the mean of the scores is not 0.
TEST(QuantizedLikelihood, HasANonzeroMeanScoreForAWrongSigma) {
  const boost::math::normal normal(0.3, 0.5);
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = 0.55;
  noise.resolution = 1;
  double sigma_score = 0;
  for (int k = -8; k <= 8; ++k) {
    sigma_score += Probability(normal, k - 0.5, k + 0.5) * noise.LikelihoodAt(k, 0.3).sigma_score;
  }
  EXPECT_LT(sigma_score, -0.05);
}

// ---- The likeliest σ -----------------------------------------------------------------------------------------------

/// Readings of a slow swing of the model.
struct Sample {
  NoiseModel noise;
  Eigen::VectorXd value;
  Eigen::VectorXd readings;
};

template <typename Distribution>
Sample Drawn(NoiseFamily family, double sigma, double resolution, Distribution draw, int count = 600) {
  Sample sample;
  sample.noise.family = family;
  sample.noise.resolution = resolution;
  sample.readings = Eigen::VectorXd::LinSpaced(count, 0, 40).array().sin() * 7;
  sample.value = sample.readings;
  std::mt19937_64 generator(5);
  for (double& x : sample.value) {
    x += sigma * draw(generator);
    if (resolution > 0) x = resolution * std::round(x / resolution);
  }
  return sample;
}

using Normal = boost::random::normal_distribution<double>;

/// The maximum likelihood σ by Brent's method in ln σ.
double SigmaOfBrent(const Sample& sample, double low, double high) {
  const auto minus_log = [&](double lambda) {
    NoiseModel noise = sample.noise;
    noise.sigma = std::exp(lambda);
    return -LogLikelihood(noise, sample.value, sample.readings);
  };
  return std::exp(boost::math::tools::brent_find_minima(minus_log, std::log(low), std::log(high), 40).first);
}

TEST(MostLikelySigma, IsTheRmsForGaussianNoise) {
  Sample sample = Drawn(NoiseFamily::kGaussian, 0.37, 0, Normal());
  const double expected = std::sqrt((sample.value - sample.readings).squaredNorm() / 600);
  for (const double start : {1e-3, 0.3, 1.0, 50.0}) {
    sample.noise.sigma = start;
    EXPECT_NEAR(MostLikelySigma(sample.noise, sample.value, sample.readings, 1e-6) / expected, 1, 1e-3) << start;
  }
}

TEST(MostLikelySigma, MatchesBrentOnLevels) {
  for (const double sigma : {0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0}) {
    SCOPED_TRACE(sigma);
    Sample sample = Drawn(NoiseFamily::kQuantized, sigma, 1, Normal());
    const double expected = SigmaOfBrent(sample, 0.3 * sigma, 3 * sigma);
    for (const double start : {0.06, 0.3, 2.0}) {
      sample.noise.sigma = start;
      EXPECT_NEAR(MostLikelySigma(sample.noise, sample.value, sample.readings, 1e-3) / expected, 1, 1e-3) << start;
    }
    // Four standard errors. Of 600 readings, only a share of σ / q lies near an edge and carries information about σ.
    EXPECT_NEAR(expected / sigma, 1, 4 / std::sqrt(600 * std::min(2 * sigma, 1.0)));
  }
}

TEST(MostLikelySigma, MatchesBrentForStudentsNoise) {
  Sample sample = Drawn(NoiseFamily::kStudent, 0.2, 0, boost::random::student_t_distribution<double>(4));
  const double expected = SigmaOfBrent(sample, 0.02, 2);
  for (const double start : {0.01, 0.2, 5.0}) {
    sample.noise.sigma = start;
    EXPECT_NEAR(MostLikelySigma(sample.noise, sample.value, sample.readings, 1e-6) / expected, 1, 1e-3) << start;
  }
  EXPECT_NEAR(expected / 0.2, 1, 4 / std::sqrt(600));
}

TEST(MostLikelySigma, FollowsHubersProposalTwoForHubersNoise) {
  const double width = NoiseModel::kHuberWidth;
  const boost::math::normal normal;
  const auto square = [&](double z) { return std::min(z * z, width * width) * boost::math::pdf(normal, z); };
  using boost::math::quadrature::gauss_kronrod;
  const double expected = gauss_kronrod<double, 31>::integrate(square, -width, width) +
                          2 * gauss_kronrod<double, 31>::integrate(square, width, 12.0);
  Sample sample = Drawn(NoiseFamily::kHuber, 0.2, 0, Normal());
  for (const double start : {0.05, 0.2, 2.0}) {
    sample.noise.sigma = start;
    const double sigma = MostLikelySigma(sample.noise, sample.value, sample.readings, 1e-6);
    const Eigen::ArrayXd z = (sample.value - sample.readings).array() / sigma;
    EXPECT_NEAR(z.square().min(width * width).mean() / expected, 1, 1e-3) << start;
    EXPECT_NEAR(sigma / 0.2, 1, 4 / std::sqrt(2 * 600 * 0.8)) << start;  // its efficiency for normal noise is above .8
  }
}

TEST(MostLikelySigma, IsTheSmallestAllowedIfLevelsExplainEverySample) {
  Sample sample = Drawn(NoiseFamily::kQuantized, 0, 1, Normal());
  for (const double smallest : {0.05, 0.01}) {
    EXPECT_NEAR(MostLikelySigma(sample.noise, sample.value, sample.readings, smallest) / smallest, 1, 0.01);
  }
}

}  // namespace
}  // namespace pendulum::noise_kernel_test
