// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/residual_diagnostics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <boost/random/uniform_01.hpp>

#include "pendulum/base/distributions.h"
#include "pendulum/base/physics.h"

namespace pendulum {

double Lag1Correlation(const Eigen::VectorXd& residual) {
  const Eigen::Index n = residual.size();
  const double sum = residual.squaredNorm();
  return sum > 0 ? residual.tail(n - 1).dot(residual.head(n - 1)) / sum : 0.0;
}

/// Tests whether N Σ ρ_k², over lags k that increase like squares, exceeds its mean by six standard deviations.
/// Autocorrelated noise shows at the first lags. A misfit that oscillates with the pendulum shows at some lag within
/// one period.
bool AreAutocorrelated(const Eigen::VectorXd& residual, int longest_lag) {
  constexpr int kMaxLags = 50;
  constexpr double kDeviations = 6;
  const Eigen::Index n = residual.size();
  const double sum = residual.squaredNorm();
  const Eigen::Index longest = std::clamp<Eigen::Index>(longest_lag, 1, n / 4);
  const auto count = std::min<Eigen::Index>(longest, kMaxLags);
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
  constexpr Eigen::Index kMinSamples = 6;
  const double sigma = std::sqrt(residual.squaredNorm() / static_cast<double>(residual.size()));
  std::vector<PeriodError> errors;
  for (Eigen::Index first = 0; first + kMinSamples < time.size();) {
    Eigen::Index end = first;
    while (end < time.size() && time[end] - time[first] < period) ++end;
    const Eigen::Index count = end - first;
    if (count >= kMinSamples && end < time.size()) {
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
  return sum > ChiSquareQuantile(1 - kLevel, freedom);
}

}  // namespace

bool HavePhaseOrAmplitudeErrors(const Eigen::VectorXd& time, const Eigen::VectorXd& fitted,
                                const Eigen::VectorXd& residual, double period) {
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

/// Φ⁻¹ of the distribution function at the reading. For a quantized or censored reading, the distribution function
/// jumps; a random point within the jump is used.
Eigen::VectorXd QuantileResiduals(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                                  const Eigen::Ref<const Eigen::VectorXd>& readings) {
  if (noise.IsUncensoredGaussian()) return (value - readings) / noise.sigma;
  constexpr double kFarthest = 1e-15;  // from 0 and 1: eight standard deviations
  std::mt19937_64 generator(1);
  boost::random::uniform_01<double> uniform;
  Eigen::VectorXd residuals(value.size());
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const NoiseModel::Distribution u = noise.ForSample(i).DistributionAt(value[i], readings[i]);
    const double place = u.below + uniform(generator) * (u.at - u.below);
    const double within = std::isfinite(place) ? std::clamp(place, kFarthest, 1 - kFarthest) : 0.5;
    residuals[i] = NormalQuantile(within);
  }
  return residuals;
}

double LjungBoxP(const Eigen::VectorXd& residual) {
  constexpr Eigen::Index kMaxLags = 20;
  const Eigen::Index n = residual.size();
  const Eigen::Index lags = std::min(kMaxLags, n / 5);
  const double sum = residual.squaredNorm();
  if (!(sum > 0) || !std::isfinite(sum) || lags < 1) return 1;
  double portmanteau = 0;
  for (Eigen::Index lag = 1; lag <= lags; ++lag) {
    const double correlation = residual.tail(n - lag).dot(residual.head(n - lag)) / sum;
    portmanteau += correlation * correlation / static_cast<double>(n - lag);
  }
  portmanteau *= static_cast<double>(n) * static_cast<double>(n + 2);
  return ChiSquareTail(portmanteau, static_cast<double>(lags));
}

double RunsP(const Eigen::VectorXd& residual) {
  const auto positive = static_cast<double>((residual.array() > 0).count());
  const auto n = static_cast<double>(residual.size());
  const double negative = n - positive;
  if (positive == 0 || negative == 0) return 1;
  double runs = 1;
  for (Eigen::Index i = 1; i < residual.size(); ++i) runs += (residual[i] > 0) != (residual[i - 1] > 0) ? 1 : 0;
  const double pairs = 2 * positive * negative;
  const double mean = pairs / n + 1;
  const double variance = pairs * (pairs - n) / (n * n * (n - 1));
  return std::erfc(std::abs(runs - mean) / std::sqrt(2 * variance));
}

void SetInformationCriteria(int parameters, double samples, FitStatistics& statistics) {
  const double k = parameters;
  statistics.aic = 2 * k - 2 * statistics.log_likelihood;
  statistics.aicc = statistics.aic + 2 * k * (k + 1) / std::max(samples - k - 1, 1.0);
  statistics.bic = k * std::log(samples) - 2 * statistics.log_likelihood;
}

FitStatistics ComputeStatistics(const Eigen::VectorXd& residual, const Eigen::VectorXd& quantile_residual,
                                double log_likelihood, int free_parameters) {
  const Eigen::Index samples = residual.size();
  const auto n = static_cast<double>(samples);
  const Eigen::VectorXd& z = quantile_residual;
  FitStatistics statistics;
  statistics.rms_residual = std::sqrt(residual.squaredNorm() / n);
  statistics.log_likelihood = log_likelihood;
  SetInformationCriteria(free_parameters + 1, n, statistics);
  const double sum = std::max(z.squaredNorm(), std::numeric_limits<double>::min());
  statistics.durbin_watson = (z.tail(samples - 1) - z.head(samples - 1)).squaredNorm() / sum;
  statistics.ljung_box_p = LjungBoxP(z);
  statistics.runs_p = RunsP(z);
  statistics.effective_samples = n;
  return statistics;
}

}  // namespace pendulum
