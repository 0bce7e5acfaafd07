// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residual_diagnostics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>

#include "pendulum/base/physics.h"

namespace pendulum {

double Lag1Correlation(const Eigen::VectorXd& residual) {
  const Eigen::Index n = residual.size();
  const double sum = residual.squaredNorm();
  return sum > 0 ? residual.tail(n - 1).dot(residual.head(n - 1)) / sum : 0.0;
}

bool FollowEachOther(const Eigen::VectorXd& residual, int longest_lag) {
  constexpr int kMostLags = 50;
  constexpr double kDeviations = 6;
  const Eigen::Index n = residual.size();
  const double sum = residual.squaredNorm();
  const Eigen::Index longest = std::clamp<Eigen::Index>(longest_lag, 1, n / 4);
  const auto count = std::min<Eigen::Index>(longest, kMostLags);
  if (!(sum > 0)) return false;
  double portmanteau = 0;
  Eigen::Index lag = 0;
  for (Eigen::Index i = 1; i <= count; ++i) {
    lag = std::max(lag + 1, longest * i * i / (count * count));
    const double correlation = residual.tail(n - lag).dot(residual.head(n - lag)) / sum;
    portmanteau += static_cast<double>(n) * correlation * correlation;
  }
  const auto mean = static_cast<double>(count);
  return portmanteau > mean + kDeviations * std::sqrt(2 * mean);
}

namespace {

/// Errors of phase and amplitude in one period, in standard errors.
using PeriodError = Eigen::Vector2d;

std::vector<PeriodError> PeriodErrors(const Eigen::VectorXd& time, const Eigen::VectorXd& fitted,
                                      const Eigen::VectorXd& residual, double period) {
  constexpr Eigen::Index kFewest = 6;
  const double sigma = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  std::vector<PeriodError> errors;
  for (Eigen::Index first = 0; first + kFewest < time.size();) {
    Eigen::Index end = first;
    while (end < time.size() && time[end] - time[first] < period) ++end;
    const Eigen::Index count = end - first;
    if (count >= kFewest && end < time.size()) {
      const Eigen::ArrayXd rise = fitted.segment(first + 1, count).array() - fitted.segment(first, count).array();
      const Eigen::ArrayXd step = time.segment(first + 1, count).array() - time.segment(first, count).array();
      Eigen::MatrixX2d basis(count, 2);
      const Eigen::ArrayXd reading = fitted.segment(first, count).array();
      basis << rise / step, reading - reading.mean();
      const Eigen::Vector2d norms = basis.colwise().norm();
      if (norms.minCoeff() > 0) {
        basis = basis * norms.cwiseInverse().asDiagonal();
        errors.emplace_back(basis.transpose() * residual.segment(first, count) / sigma);
      }
    }
    first = std::max(end, first + 1);
  }
  return errors;
}

bool Exceeds(double sum, double freedom) {
  constexpr double kLevel = 1e-4;
  return sum > boost::math::quantile(boost::math::complement(boost::math::chi_squared(freedom), kLevel));
}

}  // namespace

bool SwingAlong(const Eigen::VectorXd& time, const Eigen::VectorXd& fitted, const Eigen::VectorXd& residual,
                double period) {
  constexpr int kSlowest = 6;
  if (!(residual.squaredNorm() > 0)) return false;
  const std::vector<PeriodError> errors = PeriodErrors(time, fitted, residual, period);
  const auto count = static_cast<int>(errors.size());
  if (count < 4) return false;
  double all = 0;
  double slow = 0;
  for (const PeriodError& error : errors) all += error.squaredNorm();
  const int cosines = std::min(kSlowest, count / 2);
  for (int k = 0; k < cosines; ++k) {
    PeriodError sum = PeriodError::Zero();
    for (int i = 0; i < count; ++i) sum += std::cos(kPi * k * (i + 0.5) / count) * errors[i];
    slow += (k == 0 ? 1.0 : 2.0) / count * sum.squaredNorm();
  }
  return Exceeds(all, 2.0 * count) || Exceeds(slow, 2.0 * cosines);
}

FitStatistics ComputeStatistics(const Eigen::VectorXd& residual, int free_parameters, double resolution) {
  const Eigen::Index samples = residual.size();
  const auto n = static_cast<double>(samples);
  const double k = free_parameters + 1;
  // Residuals that vanish would make the likelihood infinite; the smallest double keeps it a number.
  const double sum = std::max(residual.squaredNorm(), std::numeric_limits<double>::min());
  FitStatistics statistics;
  statistics.rms_residual = std::sqrt(sum / n);
  statistics.log_likelihood =
      -0.5 * n * (std::log(2 * kPi * sum / n) + 1) + (resolution > 0 ? n * std::log(resolution) : 0.0);
  statistics.aic = 2 * k - 2 * statistics.log_likelihood;
  statistics.aicc = statistics.aic + 2 * k * (k + 1) / std::max(n - k - 1, 1.0);
  statistics.bic = k * std::log(n) - 2 * statistics.log_likelihood;
  statistics.durbin_watson = (residual.tail(samples - 1) - residual.head(samples - 1)).squaredNorm() / sum;
  return statistics;
}

}  // namespace pendulum
