// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fitting/residuals/burg.h"
#include "fitting/residuals/memory_filter.h"
#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// The kind of process that a place describes. A place is a vector of unbounded parameters. The first is a scale: ln of
/// the standard deviation of the innovations, or of z if the process is continuous. The others are artanh of the
/// partial autocorrelations, artanh of φ and θ, or ln τ and, if there is a white share, its logit.
struct MemoryFamily {
  Autocorrelation::Kind kind = Autocorrelation::Kind::kWhite;
  Eigen::Index parameters = 1;
  double interval = 0;  // s
  double rounding_variance = 0;
};

inline constexpr double kMostPartial = 0.99999;

inline double PartialAt(double place) { return kMostPartial * std::tanh(place); }

inline double PlaceOf(double memory) {
  return std::atanh(std::clamp(memory / kMostPartial, -kMostPartial, kMostPartial));
}

inline double ShareAt(double place) { return 1 / (1 + std::exp(-place)); }

inline MemoryFamily FamilyOf(const Autocorrelation& like, double rounding_variance) {
  MemoryFamily family{like.kind, 1, like.interval, rounding_variance};
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
inline std::vector<double> ReflectionOf(std::vector<double> memory) {
  for (std::size_t order = memory.size(); order > 1; --order) {
    const double last = std::clamp(memory[order - 1], -kMostPartial, kMostPartial);
    const std::vector<double> longer = memory;
    for (std::size_t j = 0; j + 1 < order; ++j) {
      memory[j] = (longer[j] + last * longer[order - 2 - j]) / (1 - last * last);
    }
  }
  return memory;
}

inline std::vector<double> ReflectionAt(const Eigen::VectorXd& place) {
  std::vector<double> reflection;
  for (const double p : place.tail(place.size() - 1)) reflection.push_back(PartialAt(p));
  return reflection;
}

/// The variance of z and its autocorrelation at a place.
struct MemoryProcess {
  Autocorrelation memory;
  double variance = 0;
};

inline MemoryProcess ProcessAt(const MemoryFamily& family, const Eigen::VectorXd& place) {
  MemoryProcess process{{}, std::exp(2 * place[0])};
  Autocorrelation& memory = process.memory;
  memory.kind = family.kind;
  memory.interval = family.interval;
  if (family.kind == Autocorrelation::Kind::kContinuous) {
    memory.decay_time = std::exp(place[1]);
    if (place.size() > 2) memory.white_share = ShareAt(place[2]);
    return process;
  }
  if (family.kind == Autocorrelation::Kind::kMixed) {
    const double phi = PartialAt(place[1]), theta = PartialAt(place[2]);
    memory.autoregressive = {phi};
    memory.moving_average = theta;
    memory.innovation_variance = (1 - phi * phi) / ((1 - phi * phi) + (phi + theta) * (phi + theta));
  } else {
    const std::vector<double> reflection = ReflectionAt(place);
    memory.autoregressive = FromReflection(reflection);
    for (const double r : reflection) memory.innovation_variance *= (1 - r) * (1 + r);
  }
  process.variance /= memory.innovation_variance;
  return process;
}

/// Correlations ρ_0..ρ_{p-1} of an autoregression, computed lag by lag from the partial ones (Levinson 1947, Durbin
/// 1960).
inline Eigen::VectorXd CorrelationsOf(const std::vector<double>& reflection) {
  const auto order = static_cast<Eigen::Index>(reflection.size());
  Eigen::VectorXd correlation = Eigen::VectorXd::Ones(order);
  std::vector<double> memory;
  double left = 1;
  for (Eigen::Index lag = 1; lag < order; ++lag) {
    const double last = reflection[lag - 1];
    correlation[lag] = last * left;
    for (Eigen::Index j = 1; j < lag; ++j) correlation[lag] += memory[j - 1] * correlation[lag - j];
    memory = FromReflection({reflection.begin(), reflection.begin() + lag});
    left *= (1 - last) * (1 + last);
  }
  return correlation;
}

/// Covariance of the states divided by the variance of z: a_0 = z_t, a_i = Σ_l φ_{i+l} z_{t-l}.
inline Eigen::MatrixXd StateCovariance(const std::vector<double>& memory, const std::vector<double>& reflection) {
  const auto order = static_cast<Eigen::Index>(memory.size());
  const Eigen::VectorXd correlation = CorrelationsOf(reflection);
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(order, order);
  Eigen::MatrixXd lagged(order, order);
  state(0, 0) = 1;
  for (Eigen::Index i = 0; i < order; ++i) {
    for (Eigen::Index j = 0; j < order; ++j) lagged(i, j) = correlation[std::abs(i - j)];
    for (Eigen::Index lag = 1; i > 0 && i + lag <= order; ++lag) state(i, lag) = memory[i + lag - 1];
  }
  return state * lagged * state.transpose();
}

inline FilteredProcess FilteredAt(const MemoryFamily& family, const Eigen::VectorXd& place) {
  const auto [memory, variance] = ProcessAt(family, place);
  const double innovations = memory.innovation_variance * variance;
  FilteredProcess process{memory.autoregressive, {1}, innovations, {}, family.rounding_variance, memory.interval};
  if (family.kind == Autocorrelation::Kind::kContinuous) {
    process.autoregressive = {0};
    process.decay_time = memory.decay_time;
    process.white_variance += memory.white_share * variance;
    process.stationary = Eigen::MatrixXd::Constant(1, 1, (1 - memory.white_share) * variance);
  } else if (family.kind == Autocorrelation::Kind::kMixed) {
    const double theta = memory.moving_average;
    process.autoregressive.push_back(0);
    process.response.push_back(theta);
    process.stationary = innovations * Eigen::Matrix2d{{1 / memory.innovation_variance, theta}, {theta, theta * theta}};
  } else {
    process.response.resize(memory.autoregressive.size(), 0);
    process.stationary = variance * StateCovariance(memory.autoregressive, ReflectionAt(place));
  }
  return process;
}

}  // namespace pendulum
