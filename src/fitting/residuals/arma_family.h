// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fitting/residuals/arma_filter.h"
#include "fitting/residuals/burg.h"
#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// The kind of process that a place describes. A place is a vector of unbounded parameters. The first is a scale: ln of
/// the standard deviation of the innovations, or of z if the process is continuous. The remaining ones are artanh of
/// the partial autocorrelations, artanh of φ and θ, or ln τ and, if there is a white share, its logit.
struct ArmaFamily {
  Autocorrelation::Kind kind = Autocorrelation::Kind::kWhite;
  Eigen::Index parameters = 1;
  double interval = 0;  // s
  double rounding_variance = 0;
};

inline constexpr double kMaxPartial = 0.99999;

inline double PartialFromUnbounded(double place) { return kMaxPartial * std::tanh(place); }

inline double UnboundedFromPartial(double partial) {
  return std::atanh(std::clamp(partial / kMaxPartial, -kMaxPartial, kMaxPartial));
}

inline double ShareFromLogit(double place) { return 1 / (1 + std::exp(-place)); }

inline ArmaFamily FamilyOf(const Autocorrelation& like, double rounding_variance) {
  ArmaFamily family{like.kind, 1, like.interval, rounding_variance};
  switch (like.kind) {
    case Autocorrelation::Kind::kAutoregressive:
      family.parameters += static_cast<Eigen::Index>(like.autoregressive.size());
      break;
    case Autocorrelation::Kind::kMixed: family.parameters += 2; break;
    case Autocorrelation::Kind::kContinuous: family.parameters += like.white_share > 0 ? 2 : 1; break;
    case Autocorrelation::Kind::kWhite: break;
  }
  if (family.parameters == 1) family.kind = Autocorrelation::Kind::kWhite;
  return family;
}

/// Partial autocorrelations of an autoregression: Levinson's recursion in reverse.
inline std::vector<double> ReflectionOf(std::vector<double> autoregression) {
  for (std::size_t order = autoregression.size(); order > 1; --order) {
    const double last = std::clamp(autoregression[order - 1], -kMaxPartial, kMaxPartial);
    const std::vector<double> longer = autoregression;
    for (std::size_t j = 0; j + 1 < order; ++j) {
      autoregression[j] = (longer[j] + last * longer[order - 2 - j]) / (1 - last * last);
    }
  }
  return autoregression;
}

inline std::vector<double> ReflectionAt(const Eigen::VectorXd& place) {
  std::vector<double> reflection;
  for (const double p : place.tail(place.size() - 1)) reflection.push_back(PartialFromUnbounded(p));
  return reflection;
}

/// The variance of z and its autocorrelation at a place.
struct ArmaProcess {
  Autocorrelation autocorrelation;
  double variance = 0;
};

inline ArmaProcess ProcessAt(const ArmaFamily& family, const Eigen::VectorXd& place) {
  ArmaProcess process{{}, std::exp(2 * place[0])};
  Autocorrelation& autocorrelation = process.autocorrelation;
  autocorrelation.kind = family.kind;
  autocorrelation.interval = family.interval;
  if (family.kind == Autocorrelation::Kind::kContinuous) {
    autocorrelation.decay_time = std::exp(place[1]);
    if (place.size() > 2) autocorrelation.white_share = ShareFromLogit(place[2]);
    return process;
  }
  if (family.kind == Autocorrelation::Kind::kMixed) {
    const double phi = PartialFromUnbounded(place[1]), theta = PartialFromUnbounded(place[2]);
    autocorrelation.autoregressive = {phi};
    autocorrelation.moving_average = theta;
    autocorrelation.innovation_variance = (1 - phi * phi) / ((1 - phi * phi) + (phi + theta) * (phi + theta));
  } else {
    const std::vector<double> reflection = ReflectionAt(place);
    autocorrelation.autoregressive = CoefficientsFromReflection(reflection);
    for (const double r : reflection) autocorrelation.innovation_variance *= (1 - r) * (1 + r);
  }
  process.variance /= autocorrelation.innovation_variance;
  return process;
}

/// Correlations ρ_0..ρ_{p-1} of an autoregression, computed lag by lag from the partial autocorrelations (Levinson
/// 1947, Durbin 1960).
inline Eigen::VectorXd CorrelationsOf(const std::vector<double>& reflection) {
  const auto order = static_cast<Eigen::Index>(reflection.size());
  Eigen::VectorXd correlation = Eigen::VectorXd::Ones(order);
  std::vector<double> autoregression;
  double left = 1;
  for (Eigen::Index lag = 1; lag < order; ++lag) {
    const double last = reflection[lag - 1];
    correlation[lag] = last * left;
    for (Eigen::Index j = 1; j < lag; ++j) correlation[lag] += autoregression[j - 1] * correlation[lag - j];
    autoregression = CoefficientsFromReflection({reflection.begin(), reflection.begin() + lag});
    left *= (1 - last) * (1 + last);
  }
  return correlation;
}

/// Covariance of the states divided by the variance of z: a_0 = z_t, a_i = Σ_l φ_{i+l} z_{t-l}.
inline Eigen::MatrixXd StateCovariance(const std::vector<double>& autoregression,
                                       const std::vector<double>& reflection) {
  const auto order = static_cast<Eigen::Index>(autoregression.size());
  const Eigen::VectorXd correlation = CorrelationsOf(reflection);
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(order, order);
  Eigen::MatrixXd lagged(order, order);
  state(0, 0) = 1;
  for (Eigen::Index i = 0; i < order; ++i) {
    for (Eigen::Index j = 0; j < order; ++j) lagged(i, j) = correlation[std::abs(i - j)];
    for (Eigen::Index lag = 1; i > 0 && i + lag <= order; ++lag) state(i, lag) = autoregression[i + lag - 1];
  }
  return state * lagged * state.transpose();
}

inline FilteredProcess FilteredAt(const ArmaFamily& family, const Eigen::VectorXd& place) {
  const auto [autocorrelation, variance] = ProcessAt(family, place);
  const double innovations = autocorrelation.innovation_variance * variance;
  FilteredProcess process{autocorrelation.autoregressive, {1}, innovations, {}, family.rounding_variance,
                          autocorrelation.interval};
  if (family.kind == Autocorrelation::Kind::kContinuous) {
    process.autoregressive = {0};
    process.decay_time = autocorrelation.decay_time;
    process.white_variance += autocorrelation.white_share * variance;
    process.stationary = Eigen::MatrixXd::Constant(1, 1, (1 - autocorrelation.white_share) * variance);
  } else if (family.kind == Autocorrelation::Kind::kMixed) {
    const double theta = autocorrelation.moving_average;
    process.autoregressive.push_back(0);
    process.response.push_back(theta);
    process.stationary =
        innovations * Eigen::Matrix2d{{1 / autocorrelation.innovation_variance, theta}, {theta, theta * theta}};
  } else {
    process.response.resize(autocorrelation.autoregressive.size(), 0);
    process.stationary = variance * StateCovariance(autocorrelation.autoregressive, ReflectionAt(place));
  }
  return process;
}

}  // namespace pendulum
