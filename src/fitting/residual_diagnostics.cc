// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residual_diagnostics.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
