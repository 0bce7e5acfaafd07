// SPDX-License-Identifier: Apache-2.0
// Correlated residuals, and their likelihood by a dense covariance matrix.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <boost/random/normal_distribution.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/residuals/arma_likelihood.h"
#include "tests/fitting/correlated_noise.h"

namespace pendulum {

inline constexpr double kSampleInterval = 0.01;  // s, of EvenTimes

// ---- The likelihood computed independently: a dense covariance matrix -----------------------------------------------

/// Correlations of lags 0..longest, from the weights ψ of an infinite moving average (Box & Jenkins, section 3.4).
inline std::vector<double> Correlations(const Autocorrelation& autocorrelation, std::size_t longest) {
  constexpr std::size_t kWeights = 20'000;
  std::vector<double> psi(kWeights, 0);
  psi[0] = 1;
  for (std::size_t k = 1; k < kWeights; ++k) {
    if (k == 1) psi[k] = autocorrelation.moving_average;
    for (std::size_t j = 1; j <= std::min(k, autocorrelation.autoregressive.size()); ++j) {
      psi[k] += autocorrelation.autoregressive[j - 1] * psi[k - j];
    }
  }
  std::vector<double> correlation;
  for (std::size_t lag = 0; lag <= longest; ++lag) {
    double sum = 0;
    for (std::size_t k = 0; k + lag < kWeights; ++k) sum += psi[k] * psi[k + lag];
    correlation.push_back(autocorrelation.innovation_variance * sum);
  }
  return correlation;
}

/// Covariance of z plus rounding.
inline Eigen::MatrixXd Covariance(const Autocorrelation& autocorrelation, double sigma, double rounding_variance,
                                  const Eigen::VectorXd& time) {
  const Eigen::Index size = time.size();
  std::vector<double> correlation;
  if (autocorrelation.kind == Autocorrelation::Kind::kAutoregressive ||
      autocorrelation.kind == Autocorrelation::Kind::kMixed) {
    correlation = Correlations(autocorrelation,
                               static_cast<std::size_t>(std::round((time[size - 1] - time[0]) / kSampleInterval)));
  }
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      const double step = std::abs(time[i] - time[j]);
      double rho = i == j ? 1 : 0;
      if (!correlation.empty()) rho = correlation[static_cast<std::size_t>(std::round(step / kSampleInterval))];
      if (autocorrelation.kind == Autocorrelation::Kind::kContinuous && i != j) {
        rho = (1 - autocorrelation.white_share) * std::exp(-step / autocorrelation.decay_time);
      }
      covariance(i, j) = sigma * sigma * rho + (i == j ? rounding_variance : 0);
    }
  }
  return covariance;
}

inline double DenseLogLikelihood(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& left) {
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::ArrayXd diagonal = root.matrixLLT().diagonal().array();
  return -diagonal.log().sum() - 0.5 * root.matrixL().solve(left).squaredNorm() -
         0.5 * static_cast<double>(left.size()) * std::log(2 * kPi);
}

inline double DenseLogLikelihood(const CorrelatedResiduals& data, const Autocorrelation& autocorrelation, double sigma,
                                 const Eigen::VectorXd& shift) {
  return DenseLogLikelihood(Covariance(autocorrelation, sigma, data.rounding_variance, data.time),
                            data.residual - data.jacobian * shift);
}

inline double DenseLogLikelihood(const CorrelatedResiduals& data, const CorrelatedLikelihood& found) {
  return DenseLogLikelihood(data, found.autocorrelation, found.sigma, found.shift);
}

// ---- Examples ------------------------------------------------------------------------------------------------------

inline Autocorrelation Autoregressive(std::vector<double> autoregression) {
  Autocorrelation like{Autocorrelation::Kind::kAutoregressive, std::move(autoregression)};
  like.interval = kSampleInterval;
  like.innovation_variance = 1 / Correlations(like, 0)[0];
  return like;
}

inline Autocorrelation Mixed(double phi, double theta) {
  Autocorrelation like{Autocorrelation::Kind::kMixed, {phi}, theta};
  like.interval = kSampleInterval;
  like.innovation_variance = 1 / Correlations(like, 0)[0];
  return like;
}

inline Autocorrelation Continuous(double decay_time, double white_share) {
  return {Autocorrelation::Kind::kContinuous, {}, 0, 1, kSampleInterval, decay_time, white_share};
}

inline Eigen::VectorXd NormalNumbers(Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> normal;
  Eigen::VectorXd numbers(count);
  for (double& number : numbers) number = normal(generator);
  return numbers;
}

/// Residuals without a fit.
inline CorrelatedResiduals Residuals(const Eigen::VectorXd& time, const Eigen::VectorXd& residual,
                                     double rounding_variance) {
  return {time, residual, Eigen::MatrixXd(time.size(), 0), {}, {}, rounding_variance};
}

/// Residuals drawn from the dense covariance matrix.
inline CorrelatedResiduals Drawn(const Autocorrelation& autocorrelation, double sigma, double rounding_variance,
                                 const Eigen::VectorXd& time, std::uint64_t seed) {
  const Eigen::LLT<Eigen::MatrixXd> root(Covariance(autocorrelation, sigma, rounding_variance, time));
  return Residuals(time, root.matrixL() * NormalNumbers(time.size(), seed), rounding_variance);
}

inline void AddColumns(const Eigen::MatrixXd& columns, CorrelatedResiduals* data) {
  data->jacobian = columns;
  data->lowest.setConstant(columns.cols(), -std::numeric_limits<double>::infinity());
  data->highest.setConstant(columns.cols(), std::numeric_limits<double>::infinity());
}

}  // namespace pendulum
