// SPDX-License-Identifier: Apache-2.0
// Swings for tests of the closed forms. None of them uses this project's trajectory. Swings without friction use
// Jacobi's elliptic functions, swings with friction use Runge-Kutta steps.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <boost/random/normal_distribution.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/recording/recording.h"
#include "tests/model/undamped_pendulum.h"

namespace pendulum {

/// Returns the value. Without a value it ends the test with the error message.
template <typename T>
T Must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

/// A recording of y(t) at t = start + i / rate for 0 <= i < duration * rate.
inline Recording Sample(const std::function<double(double)>& y, double duration, double rate, double start = 0) {
  const auto count = static_cast<Eigen::Index>(std::lround(duration * rate));
  Recording recording;
  recording.time = start + Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)) / rate;
  recording.value = recording.time.unaryExpr(y);
  return Must(MakeRecording(std::move(recording)));
}

/// The same recording with white Gaussian noise added.
inline Recording WithNoise(Recording recording, double sigma, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  boost::random::normal_distribution<double> draw(0, sigma);
  for (double& value : recording.value) value += draw(generator);
  return recording;
}

/// The same recording without the samples with from < time < to.
inline Recording WithoutSamples(const Recording& recording, double from, double to) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (recording.time[i] <= from || recording.time[i] >= to) kept.push_back(i);
  }
  Recording rest = recording;
  rest.time = recording.time(kept).eval();
  rest.value = recording.value(kept).eval();
  return Must(MakeRecording(std::move(rest)));
}

/// Rate of the undamped pendulum with a turning point at `amplitude` at t = 0: the time derivative of
/// sin(θ/2) = k cd(ω0 t, k), k = sin(amplitude / 2).
inline double UndampedRate(double amplitude, double natural_frequency, double t) {
  const double k = std::sin(0.5 * amplitude);
  return -2 * natural_frequency * k * std::cos(0.5 * amplitude) * boost::math::jacobi_sd(k, natural_frequency * t);
}

/// A decay to simulate: θ'' = -ω0² (sin θ + b ω + sign(ω) (τ + c ω²)), from rest at `amplitude`.
struct Decay {
  double natural_frequency = 5;  // rad/s
  double viscous = 0;            // s
  double coulomb = 0;            // 1
  double drag = 0;               // s^2
  double amplitude = 1;          // rad
  double duration = 30;          // s
  Quantity quantity = Quantity::kAngle;
};

/// Classical Runge-Kutta steps of 1 ms; every tenth is recorded. In a step across a reversal the Coulomb torque is
/// wrong for part of a millisecond, which causes an error of at most 1e-5 of the amplitude.
inline Recording SimulateDecay(const Decay& decay) {
  constexpr double kStep = 1e-3;
  constexpr int kEvery = 10;
  const auto acceleration = [&](const Eigen::Array2d& x) {
    const double sign = x[1] > 0 ? 1 : -1;
    const double friction = decay.viscous * x[1] + sign * (decay.coulomb + decay.drag * x[1] * x[1]);
    const double scale = -decay.natural_frequency * decay.natural_frequency;
    return Eigen::Array2d(x[1], scale * (std::sin(x[0]) + friction));
  };
  const bool is_rate = decay.quantity == Quantity::kRate;
  const auto count = static_cast<Eigen::Index>(std::lround(decay.duration / (kEvery * kStep)));
  Recording recording;
  recording.quantity = decay.quantity;
  recording.time = Eigen::ArrayXd::LinSpaced(count, 0, static_cast<double>(count - 1)) * (kEvery * kStep);
  recording.value.resize(count);
  Eigen::Array2d x(decay.amplitude, -1e-12);
  for (Eigen::Index i = 0; i < count; ++i) {
    recording.value[i] = is_rate ? x[1] : x[0];
    for (int step = 0; step < kEvery; ++step) {
      const Eigen::Array2d k1 = acceleration(x), k2 = acceleration(x + 0.5 * kStep * k1);
      const Eigen::Array2d k3 = acceleration(x + 0.5 * kStep * k2), k4 = acceleration(x + kStep * k3);
      x += kStep / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return Must(MakeRecording(std::move(recording)));
}

}  // namespace pendulum
