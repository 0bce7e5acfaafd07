// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/series.h"

namespace pendulum {

/// The equation of motion I θ'' = -g(θ) - T(θ') in units of G (MODEL.md eq. (4)): inertia I/G [s^2], friction / G.
template <FrictionModel F, typename T>
struct Pendulum {
  Gravity gravity = Gravity::kSine;
  T inertia;
  std::array<T, kFrictionParameters<F>> friction;
};

/// The state at one instant. With a dual T the partial derivatives of angle and rate are those at a fixed time *since*
/// this instant, and the partials of `time` say how the instant itself moves (it does once a reversal has been passed).
template <typename T>
struct State {
  T time, angle, rate;  ///< s, rad, rad/s
};

/// A stretch of the trajectory: θ(t) = Σ angle[n] (t - start)^n for start <= t <= end, n = 0..order; order 0 is rest.
/// With a dual T the partial derivatives of θ are those at a fixed absolute time t.
template <typename T>
struct Segment {
  double start = 0, end = 0;  ///< s
  int order = 0;
  Series<T> angle;
};

/// Σ c_k τ^k for k = 0..order, by Horner's rule.
template <typename T>
T EvaluateSeries(const Series<T>& c, int order, double tau) {
  T sum = c[order];
  for (int k = order - 1; k >= 0; --k) sum = sum * tau + c[k];
  return sum;
}

/// Order of the expansion for a local tolerance: 1 - 0.6 ln(tolerance), within the room of Series. The asymptotic
/// optimum is 1 - 0.5 ln(tolerance) (Jorba & Zou, Experimental Mathematics 14:99, 2005); reversals cut steps short and
/// each step has a cost of its own, so a little more is faster: measured at tolerances 1e-9 to 1e-12.
inline int OrderForTolerance(double tolerance) {
  return std::clamp(static_cast<int>(std::ceil(1.0 - 0.6 * std::log(tolerance))), 8, kMaxOrder);
}

/// Restoring torque g(θ) in units of G: sin θ or θ.
inline double GravityTorque(Gravity gravity, double angle) {
  return gravity == Gravity::kSine ? std::sin(angle) : angle;
}

/// The values of a pendulum's parameters, without derivatives.
template <FrictionModel F, typename T>
Pendulum<F, double> Values(const Pendulum<F, T>& pendulum) {
  Pendulum<F, double> values{pendulum.gravity, Value(pendulum.inertia), {}};
  std::transform(pendulum.friction.begin(), pendulum.friction.end(), values.friction.begin(),
                 [](const T& p) { return Value(p); });
  return values;
}

/// Direction in which the pendulum moves on from a state: ±1, or 0 when static friction holds it (MODEL.md eq. (10)).
template <FrictionModel F>
double DirectionOfMotion(const Pendulum<F, double>& pendulum, double angle, double rate) {
  if (rate != 0) return rate > 0 ? 1.0 : -1.0;
  const double torque = GravityTorque(pendulum.gravity, angle);
  const double direction = torque > 0 ? -1.0 : 1.0;
  const double holding = direction * F::Torque(0.0, direction, pendulum.friction.data());
  constexpr double kMargin = 1.0 + 1e-12;  // at equality rounding must not start a motion
  return std::abs(torque) > holding * kMargin ? direction : 0.0;
}

/// Taylor coefficients 0..order of the angle and 0..order-1 of the rate in one direction of motion. MODEL.md eq. (12).
template <FrictionModel F, typename T>
void ExpandSwing(const Pendulum<F, T>& pendulum, double direction, int order, const State<T>& state, Series<T>& angle,
                 Series<T>& rate) {
  SineSeries<T> sine;
  typename F::template Recurrence<T> friction;
  const T inverse_inertia = 1.0 / pendulum.inertia;
  angle[0] = state.angle;
  rate[0] = state.rate;
  for (int n = 0; n < order; ++n) {
    angle[n + 1] = rate[n] * (1.0 / (n + 1));
    if (n + 1 == order) break;
    const T gravity = pendulum.gravity == Gravity::kSine ? sine.Next(n, angle, rate) : angle[n];
    const T torque = gravity + friction(n, rate, direction, pendulum.friction.data());
    rate[n + 1] = torque * inverse_inertia * (-1.0 / (n + 1));
  }
}

/// Longest step whose truncation error stays near `tolerance` [rad]: the least of (tol / |c_k|)^(1/k) over the last
/// four coefficients (some vanish: from rest, at 90 deg), at most `longest` [s]. 0 when a coefficient is not finite.
template <typename T>
double StepLength(const Series<T>& angle, int order, double tolerance, double longest) {
  double log_step = std::numeric_limits<double>::infinity();
  for (int k = order - 3; k <= order; ++k) {
    const double size = std::abs(Value(angle[k]));
    if (!std::isfinite(size)) return 0.0;
    if (size > 0) log_step = std::min(log_step, std::log2(tolerance / size) / k);
  }
  return std::min(std::exp2(log_step), longest);
}

/// First root of the rate in (0, step], or a negative number when the direction of motion holds throughout. The step is
/// at most a quarter of the small-angle period, shorter than any half swing, so the sign at its end decides. From rest
/// the rate's root at 0 is divided out. Newton's method kept inside a bisection's bracket.
template <typename T>
double FirstReversal(const Series<T>& rate, int order, double direction, double step) {
  const int first = Value(rate[0]) == 0 ? 1 : 0;
  const auto value_and_slope = [&](double tau) {
    double value = Value(rate[order]);
    double slope = 0;
    for (int k = order - 1; k >= first; --k) {
      slope = slope * tau + value;
      value = value * tau + Value(rate[k]);
    }
    return std::pair(direction * value, direction * slope);
  };
  double high = step;
  auto [value, slope] = value_and_slope(high);
  if (value > 0) return -1;
  double low = 0;
  double root = high;
  for (int iteration = 0; iteration < 100 && value != 0; ++iteration) {
    (value > 0 ? low : high) = root;
    double next = root - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - root) <= 1e-16 * step || next == root) break;
    root = next;
    std::tie(value, slope) = value_and_slope(root);
  }
  return root;
}

/// The state at the reversal `tau` after the start of an expansion: the rate is 0 with all its derivatives, and the
/// instant moves by -ω_p / α (implicit function theorem, MODEL.md eq. (16)).
template <typename T>
State<T> StateAtReversal(const State<T>& state, const Series<T>& angle, const Series<T>& rate, int order, double tau) {
  State<T> reversal{state.time + tau, EvaluateSeries(angle, order, tau), T(0.0)};
  if constexpr (DualNumber<T>) {
    double acceleration = 0;
    for (int k = order - 1; k >= 1; --k) acceleration = acceleration * tau + k * rate[k].a;
    reversal.time.v -= EvaluateSeries(rate, order - 1, tau).v / acceleration;
  }
  return reversal;
}

/// Turns partial derivatives at fixed time since `start` into those at fixed absolute time: θ_p - θ' start_p,
/// coefficient by coefficient (MODEL.md eq. (17)).
template <typename T>
void FixAbsoluteTime(const T& start, int order, Series<T>& angle) {
  if constexpr (DualNumber<T>) {
    for (int k = 0; k < order; ++k) angle[k].v -= ((k + 1) * angle[k + 1].a) * start.v;
  }
}

}  // namespace pendulum
