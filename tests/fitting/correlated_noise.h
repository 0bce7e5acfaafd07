// SPDX-License-Identifier: Apache-2.0
// Seeded autocorrelated noise.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>
#include <boost/random/normal_distribution.hpp>

namespace pendulum {

inline Eigen::VectorXd EvenTimes(Eigen::Index count) {
  return Eigen::VectorXd::LinSpaced(count, 0, 0.01 * static_cast<double>(count - 1));
}

/// Noise of total variance 1: a part with correlation exp(-Δt / τ), and an independent part with the share
/// white_share. Exact at any time stamps. τ = 0: white.
inline Eigen::VectorXd CorrelatedNoise(const Eigen::VectorXd& time, double decay_time, double white_share,
                                       std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> normal;
  Eigen::VectorXd noise(time.size());
  double state = normal(generator);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    const double kept = i > 0 && decay_time > 0 ? std::exp((time[i - 1] - time[i]) / decay_time) : 0;
    state = kept * state + std::sqrt(1 - kept * kept) * normal(generator);
    noise[i] = std::sqrt(1 - white_share) * state + std::sqrt(white_share) * normal(generator);
  }
  return noise;
}

/// AR(1) at EvenTimes; phi, in [0, 1), is the correlation of neighbouring samples.
inline Eigen::VectorXd FirstOrderNoise(Eigen::Index count, double phi, double white_share, std::uint64_t seed) {
  return CorrelatedNoise(EvenTimes(count), phi > 0 ? -0.01 / std::log(phi) : 0, white_share, seed);
}

/// The times after each sample is removed with this probability.
inline Eigen::VectorXd WithSomeMissing(const Eigen::VectorXd& time, double probability, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Eigen::VectorXd kept(time.size());
  Eigen::Index count = 0;
  for (const double t : time) {
    if (std::generate_canonical<double, 53>(generator) >= probability) kept[count++] = t;
  }
  return kept.head(count);
}

/// Times of random events, 100 per second.
inline Eigen::VectorXd EventTimes(Eigen::Index count, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Eigen::VectorXd time(count);
  double now = 0;
  for (double& t : time) t = now += 1e-6 - 0.01 * std::log1p(-std::generate_canonical<double, 53>(generator));
  return time;
}

/// A swing of 4.8 rad/s that decays within 50 s: its sine, its cosine, and the zero angle. N x 3.
inline Eigen::MatrixXd SwingColumns(const Eigen::VectorXd& time) {
  const Eigen::ArrayXd envelope = (-0.02 * time.array()).exp();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(time.size(), 3);
  columns.col(0) = envelope * (4.8 * time.array()).sin();
  columns.col(1) = envelope * (4.8 * time.array()).cos();
  return columns;
}

}  // namespace pendulum
