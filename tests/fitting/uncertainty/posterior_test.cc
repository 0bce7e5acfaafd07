// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::posterior_test {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kResolution = 0.003;  // rad

// With 500 effective draws, a mean has an error of 0.045 standard deviations, a standard deviation of 3 %, the quantile
// .025 of 0.12 standard deviations of a normal distribution. The tests allow three to four times that.
constexpr double kMeanError = 0.16;
constexpr double kSpreadError = 0.12;
constexpr double kQuantileError = 0.4;

LinearizedFit FitOf(const Eigen::VectorXd& value, const Eigen::VectorXd& readings, const Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(jacobian.cols());
  LinearizedFit fit{value, readings, jacobian, {}, zero, zero, zero, zero};
  fit.lower.setConstant(-kInfinity);
  fit.upper.setConstant(kInfinity);
  fit.noise.family = NoiseFamily::kQuantized;
  fit.noise.resolution = kResolution;
  fit.noise.sigma = 0.1 * kResolution;
  return fit;
}

Eigen::VectorXd Rounded(const Eigen::VectorXd& truth, double sigma, std::mt19937_64& generator) {
  boost::random::normal_distribution<double> normal;
  Eigen::VectorXd value(truth.size());
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    value[i] = kResolution * std::round((truth[i] + sigma * normal(generator)) / kResolution);
  }
  return value;
}

/// A ramp of 20 samples, 0.37 counts apart, with an offset δ; the truth is δ = 0.1 counts, without noise.
LinearizedFit Ramp() {
  const Eigen::VectorXd ramp = kResolution * Eigen::VectorXd::LinSpaced(20, 0, 19 * 0.37);
  std::mt19937_64 generator(1);
  return FitOf(Rounded(ramp.array() + 0.1 * kResolution, 0, generator), ramp, Eigen::MatrixXd::Ones(20, 1));
}

/// Log-probability of a fit's readings from erfc alone; it need not be exact in the tails.
double LogProbability(const LinearizedFit& fit, double delta, double sigma) {
  const double half = 0.5 * kResolution;
  double probability = 1;
  for (Eigen::Index i = 0; i < fit.value.size(); ++i) {
    const double model = fit.readings[i] + fit.jacobian(i, 0) * delta;
    const bool high = fit.value[i] >= fit.noise.high;
    const double from = high ? fit.noise.high : fit.value[i] - half;
    const double to = high ? kInfinity : fit.value[i] + half;
    const double scale = 1 / (std::sqrt(2.0) * sigma);
    probability *= 0.5 * (std::erfc((from - model) * scale) - std::erfc((to - model) * scale));
  }
  const double z = fit.prior_weight[0] * (delta - fit.prior_mean[0]);
  return std::log(probability) - 0.5 * z * z;
}

struct Moments {
  double mean = 0;
  double std_dev = 0;
  double lower95 = 0;
  double upper95 = 0;
  double sigma = 0;
};

/// The posterior of one parameter by quadrature on a grid of δ and log σ.
Moments ByQuadrature(const LinearizedFit& fit) {
  constexpr int kDeltas = 400;
  constexpr int kSigmas = 120;
  const double from = std::max(fit.lower[0], -2 * kResolution);
  const double to = std::min(fit.upper[0], 2 * kResolution);
  Eigen::ArrayXd density = Eigen::ArrayXd::Zero(kDeltas);
  Eigen::ArrayXd delta(kDeltas);
  double sigma_sum = 0;
  for (int i = 0; i < kDeltas; ++i) {
    delta[i] = from + (i + 0.5) / kDeltas * (to - from);
    for (int k = 0; k < kSigmas; ++k) {
      const double sigma = 2 * kResolution * std::pow(1e-5, (k + 0.5) / kSigmas);
      const double weight = sigma * std::exp(LogProbability(fit, delta[i], sigma));
      density[i] += weight;
      sigma_sum += sigma * weight;
    }
  }
  Moments moments;
  moments.sigma = sigma_sum / density.sum();
  density /= density.sum();
  moments.mean = (density * delta).sum();
  moments.std_dev = std::sqrt((density * (delta - moments.mean).square()).sum());
  double below = 0;
  for (int i = 0; i < kDeltas; ++i) {
    if (below < 0.025) moments.lower95 = delta[i];
    if (below < 0.975) moments.upper95 = delta[i];
    below += density[i];
  }
  return moments;
}

void ExpectAsByQuadrature(const LinearizedFit& fit) {
  const Result<Posterior> posterior = SamplePosterior(fit, 3);
  ASSERT_TRUE(posterior);
  const Moments expected = ByQuadrature(fit);
  EXPECT_GE(posterior->effective_draws, 500);
  EXPECT_NEAR((posterior->mean[0] - expected.mean) / expected.std_dev, 0, kMeanError);
  EXPECT_NEAR(std::sqrt(posterior->covariance(0, 0)) / expected.std_dev, 1, kSpreadError);
  EXPECT_NEAR((posterior->lower95[0] - expected.lower95) / expected.std_dev, 0, kQuantileError);
  EXPECT_NEAR((posterior->upper95[0] - expected.upper95) / expected.std_dev, 0, kQuantileError);
  EXPECT_NEAR((posterior->sigma - expected.sigma) / posterior->sigma_std_dev, 0, kMeanError);
}

TEST(SamplePosterior, MatchesQuadratureForARampWithoutNoise) { ExpectAsByQuadrature(Ramp()); }

TEST(SamplePosterior, AcceptsAStartWithinTwoCounts) {
  LinearizedFit fit = Ramp();
  fit.readings.array() += 1.5 * kResolution;  // no level allows this
  fit.noise.sigma = 0;
  ExpectAsByQuadrature(fit);
}

TEST(SamplePosterior, StaysWithinBounds) {
  LinearizedFit fit = Ramp();
  fit.lower[0] = 0;
  fit.upper[0] = 0.1 * kResolution;
  ExpectAsByQuadrature(fit);
  const Result<Posterior> posterior = SamplePosterior(fit, 4);
  ASSERT_TRUE(posterior);
  EXPECT_GE(posterior->draws.col(0).minCoeff(), fit.lower[0]);
  EXPECT_LE(posterior->draws.col(0).maxCoeff(), fit.upper[0]);
}

TEST(SamplePosterior, UsesPriors) {
  LinearizedFit fit = Ramp();
  fit.prior_mean[0] = 0.3 * kResolution;
  fit.prior_weight[0] = 1 / (0.05 * kResolution);
  ExpectAsByQuadrature(fit);
}

TEST(SamplePosterior, MatchesQuadratureForCensoredReadings) {
  LinearizedFit fit = Ramp();
  fit.noise.high = 2 * kResolution;
  fit.value = fit.value.cwiseMin(fit.noise.high);
  ExpectAsByQuadrature(fit);
}

TEST(SamplePosterior, CountsEqualSamples) {
  LinearizedFit fit = Ramp();
  const Eigen::VectorXi each_three_times = Eigen::VectorXi::LinSpaced(60, 0, 59) / 3;
  const std::vector<int> rows(each_three_times.begin(), each_three_times.end());
  fit = FitOf(fit.value(rows), fit.readings(rows), fit.jacobian(rows, Eigen::all));
  fit.value[31] += kResolution;  // so σ is not small, and two of three remain equal
  ExpectAsByQuadrature(fit);
}

TEST(SamplePosterior, IsReproducibleForASeed) {
  const Result<Posterior> first = SamplePosterior(Ramp(), 7);
  const Result<Posterior> second = SamplePosterior(Ramp(), 7);
  const Result<Posterior> other = SamplePosterior(Ramp(), 8);
  ASSERT_TRUE(first && second && other);
  EXPECT_EQ(first->draws, second->draws);
  EXPECT_NE(first->mean, other->mean);
}

/// N x 3: level, slope and curvature, with units of very different size.
Eigen::MatrixXd Parabola(int samples) {
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(samples, 0, 1);
  Eigen::MatrixXd jacobian(samples, 3);
  jacobian << Eigen::VectorXd::Ones(samples), 1e5 * x.matrix(), 1e-4 * x.square().matrix();
  return jacobian;
}

/// The score, and the information of 3 parameters and log σ, at δ and σ.
struct Newton {
  Eigen::Vector4d score = Eigen::Vector4d::Zero();
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
};

Newton NewtonAt(const LinearizedFit& fit, const Eigen::Vector4d& point) {
  NoiseModel noise = fit.noise;
  noise.sigma = std::exp(point[3]);
  const Eigen::VectorXd readings = fit.readings + fit.jacobian * point.head<3>();
  Newton newton;
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    const NoiseLikelihood l = noise.LikelihoodAt(fit.value[i], readings[i]);
    const Eigen::Vector3d row = fit.jacobian.row(i);
    newton.score.head<3>() += l.score * row;
    newton.score[3] += l.sigma_score;
    newton.information.topLeftCorner<3, 3>() += l.information * row * row.transpose();
    newton.information.topRightCorner<3, 1>() += l.mixed * row;
    newton.information.bottomLeftCorner<1, 3>() += l.mixed * row.transpose();
    newton.information(3, 3) += l.sigma_information;
  }
  return newton;
}

/// The inverse, computed after scaling to unit diagonal.
Eigen::Matrix4d Covariance(const Eigen::Matrix4d& information) {
  const Eigen::Vector4d scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix4d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

TEST(SamplePosterior, IsNormalForMuchNoise) {
  const Eigen::MatrixXd jacobian = Parabola(400);
  std::mt19937_64 generator(2);
  const Eigen::Vector3d truth = kResolution * Eigen::Vector3d(0.2, 7e-5, -3e4);
  LinearizedFit fit =
      FitOf(Rounded(jacobian * truth, 0.5 * kResolution, generator), Eigen::VectorXd::Zero(400), jacobian);
  Eigen::Vector4d point;
  point << truth, std::log(0.5 * kResolution);
  for (int step = 0; step < 20; ++step) {
    const Newton newton = NewtonAt(fit, point);
    point += Covariance(newton.information) * newton.score;
  }
  const Eigen::Matrix4d covariance = Covariance(NewtonAt(fit, point).information);
  const Result<Posterior> posterior = SamplePosterior(fit, 5);
  ASSERT_TRUE(posterior);
  for (int j = 0; j < 3; ++j) {
    const double std_dev = std::sqrt(covariance(j, j));
    EXPECT_NEAR((posterior->mean[j] - point[j]) / std_dev, 0, kMeanError) << j;
    EXPECT_NEAR(std::sqrt(posterior->covariance(j, j)) / std_dev, 1, kSpreadError) << j;
    EXPECT_NEAR((posterior->lower95[j] - point[j]) / std_dev, -1.96, kQuantileError) << j;
    EXPECT_NEAR((posterior->upper95[j] - point[j]) / std_dev, 1.96, kQuantileError) << j;
  }
  // 400 samples determine σ to 4 %; its posterior mean is larger than the maximum likelihood value by 1/400.
  EXPECT_NEAR(posterior->sigma / std::exp(point[3]), 1, 0.015);
  EXPECT_NEAR(posterior->sigma_std_dev / (std::exp(point[3]) * std::sqrt(covariance(3, 3))), 1, kSpreadError);
}

TEST(SamplePosterior, RanksTheTruthUniformly) {
  // S. Talts et al., arXiv 1804.06788: holds if the true values are drawn from the prior.
  constexpr int kProblems = 100;
  constexpr int kBins = 10;
  const Eigen::MatrixXd jacobian = Parabola(100);
  const Eigen::Vector3d spread = 0.3 * kResolution * Eigen::Vector3d(1, 1e-5, 1e4);
  std::mt19937_64 generator(11);
  boost::random::normal_distribution<double> normal;
  boost::random::uniform_01<double> uniform;
  Eigen::Array<double, kBins, 4> counts = Eigen::Array<double, kBins, 4>::Zero();
  for (int problem = 0; problem < kProblems; ++problem) {
    Eigen::Vector4d truth;
    for (int j = 0; j < 3; ++j) truth[j] = spread[j] * normal(generator);
    truth[3] = 2 * kResolution * uniform(generator);
    const Eigen::VectorXd ramp = kResolution * Eigen::VectorXd::LinSpaced(100, 0, 13);
    LinearizedFit fit = FitOf(Rounded(ramp + jacobian * truth.head<3>(), truth[3], generator), ramp, jacobian);
    fit.prior_weight = spread.cwiseInverse();
    const Result<Posterior> posterior = SamplePosterior(fit, static_cast<std::uint64_t>(problem));
    ASSERT_TRUE(posterior);
    for (int j = 0; j < 4; ++j) {
      const double rank = (posterior->draws.col(j).array() < truth[j]).cast<double>().mean();
      ++counts(std::min(static_cast<int>(kBins * rank), kBins - 1), j);
    }
  }
  constexpr double kExpected = 1.0 * kProblems / kBins;
  for (int j = 0; j < 4; ++j) {
    // χ² with 9 degrees of freedom exceeds 27.9 once in a thousand.
    EXPECT_LT((counts.col(j) - kExpected).square().sum() / kExpected, 27.9) << j << ": " << counts.col(j).transpose();
  }
}

/// A exp(-z t) cos(w t) + c of 900 samples, held at A + c for the first tenth: parameters A, z, w, phase, c.
struct Swing {
  Eigen::VectorXd angle = Eigen::VectorXd(900);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd(900, 5);

  Swing(double amplitude, double decay, double frequency, double zero) {
    for (int i = 0; i < 900; ++i) {
      const double t = std::max(0.0, (i - 89.7) * 0.02);
      const double cosine = std::exp(-decay * t) * std::cos(frequency * t);
      const double sine = std::exp(-decay * t) * std::sin(frequency * t);
      angle[i] = amplitude * cosine + zero;
      jacobian.row(i) << cosine, -t * amplitude * cosine, -t * amplitude * sine, -amplitude * sine, 1;
    }
  }
};

TEST(SamplePosterior, CoversTheTruthAndHasSmallerErrorsThanLeastSquares) {
  constexpr int kSwings = 16;
  std::mt19937_64 generator(13);
  boost::random::uniform_01<double> uniform;
  int covered = 0;
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(5);
  Eigen::ArrayXd plain_squares = Eigen::ArrayXd::Zero(5);
  for (int k = 0; k < kSwings; ++k) {
    const double decay = 0.03 + 0.05 * uniform(generator);
    const double frequency = 4 + 2 * uniform(generator);
    const Swing swing(0.5 + 0.8 * uniform(generator), decay, frequency, kResolution * uniform(generator));
    const Eigen::VectorXd value = Rounded(swing.angle, 0, generator);
    const Eigen::VectorXd error = swing.jacobian.colPivHouseholderQr().solve(value - swing.angle);
    LinearizedFit fit = FitOf(value, swing.angle + swing.jacobian * error, swing.jacobian);
    const Result<Posterior> posterior = SamplePosterior(fit, static_cast<std::uint64_t>(k));
    ASSERT_TRUE(posterior);
    for (int j = 0; j < 5; ++j) covered += posterior->lower95[j] <= -error[j] && -error[j] <= posterior->upper95[j];
    squares += (posterior->mean + error).array().square();
    plain_squares += error.array().square();
  }
  // The intervals are calibrated on average over σ in (0, 2q], and conservative at the end of that range.
  EXPECT_GE(covered, 0.93 * 5 * kSwings);
  // Errors decrease as 1/N, not as 1/sqrt(N); measured: 0.03 to 0.15 of the least-squares errors.
  EXPECT_LT((squares / plain_squares).maxCoeff(), 0.3 * 0.3);
}

void ExpectError(const LinearizedFit& fit, StatusCode code, const std::string& message) {
  const Result<Posterior> posterior = SamplePosterior(fit, 1);
  ASSERT_FALSE(posterior);
  EXPECT_EQ(posterior.error().code, code);
  EXPECT_THAT(posterior.error().message(), HasSubstr(message));
}

TEST(SamplePosterior, RefusesInconsistentSizes) {
  LinearizedFit fit = Ramp();
  fit.readings.conservativeResize(19);
  ExpectError(fit, StatusCode::kInvalidArgument, "20 values, 19 readings and 20 rows");
  fit = Ramp();
  fit.prior_mean.conservativeResize(2);
  ExpectError(fit, StatusCode::kInvalidArgument, "for each of 1 parameters, not 2");
  fit.jacobian.resize(20, 0);
  ExpectError(fit, StatusCode::kInvalidArgument, "there are none");
}

TEST(SamplePosterior, RefusesInvalidValues) {
  LinearizedFit fit = Ramp();
  fit.value[3] = std::nan("");
  ExpectError(fit, StatusCode::kInvalidArgument, "finite");
  fit = Ramp();
  fit.noise.family = NoiseFamily::kGaussian;
  ExpectError(fit, StatusCode::kInvalidArgument, "gaussian");
  fit = Ramp();
  fit.noise.sigma = -1;
  ExpectError(fit, StatusCode::kInvalidArgument, "sigma is -1");
  fit = Ramp();
  fit.lower[0] = 0.5;
  ExpectError(fit, StatusCode::kInvalidArgument, "the bounds of parameter 0, minus its fitted value, are 0.5");
}

TEST(SamplePosterior, NamesUndeterminedParameters) {
  LinearizedFit ramp = Ramp();
  LinearizedFit fit = FitOf(ramp.value, ramp.readings, Eigen::MatrixXd::Ones(20, 2));
  ExpectError(fit, StatusCode::kFailedPrecondition, "parameters 0 1 has no effect");
  fit.prior_weight[1] = 1 / kResolution;
  EXPECT_TRUE(SamplePosterior(fit, 1));
}

}  // namespace
}  // namespace pendulum::posterior_test
