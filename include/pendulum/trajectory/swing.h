// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/gravity/gravity.h"
#include "pendulum/model/series.h"

namespace pendulum {

/// The equation of motion I θ'' = -g(θ) - T(θ'), divided by the restoring torque G (MODEL.md eq. (2.1)): inertia / G
/// [s^2] and friction / G.
template <FrictionModel F, typename T>
struct Pendulum {
  Gravity gravity;
  T inertia;
  std::array<T, kFrictionParameters<F>> friction;
};

/// The state at one instant, with K states of the friction law. With a dual T the partial derivatives of angle, rate
/// and friction states are taken at a fixed time *since* this instant. The partials of `time` are those of the instant
/// itself, which depends on the parameters after a reversal.
template <typename T, int K = 0>
struct State {
  T time, angle, rate;  ///< s, rad, rad/s
  std::array<T, K> friction{};
};

/// Without friction states, the state has no array, so none is copied.
template <typename T>
struct State<T, 0> {
  T time, angle, rate;  ///< s, rad, rad/s
};

/// The state of a pendulum with friction law F.
template <FrictionModel F, typename T>
using StateOf = State<T, kFrictionStates<F>>;

/// A piece of the trajectory: θ(t) = Σ angle[n] (t - start)^n for start <= t <= end, n = 0..order; order 0 is rest.
/// Coefficients are in rad s⁻ⁿ. With a dual T `partials` are their derivatives at a fixed time since `start`; `start`
/// itself depends on the parameters, see PartialsAtFixedTime. With T = double `partials` are empty.
template <typename T>
struct Segment {
  double start = 0, end = 0;  ///< s
  PartialsFor<T> start_partials;
  int order = 0;
  Series<double> angle;
  Series<PartialsFor<T>> partials;
};

/// Partial derivatives of coefficient n of a segment's angle at a fixed absolute time t: θ_p - θ' start_p (MODEL.md
/// eq. (4.6)). For many samples, fitting/likelihood/sample_kernel.h applies the same correction at each sample.
template <DualNumber T>
PartialsFor<T> PartialsAtFixedTime(const Segment<T>& segment, int n) {
  const double rate = n < segment.order ? (n + 1) * segment.angle[n + 1] : 0.0;
  return segment.partials[n] - rate * segment.start_partials;
}

/// The rate ω(t) [rad/s] of a segment, in the same form as the angle.
template <typename T>
Segment<T> RateOf(const Segment<T>& segment) {
  Segment<T> rate;
  rate.start = segment.start;
  rate.end = segment.end;
  rate.start_partials = segment.start_partials;
  if (segment.order == 0) {  // the rate is 0 at rest
    rate.angle[0] = 0;
    rate.partials[0] = {};
    return rate;
  }
  rate.order = segment.order - 1;
  for (int n = 0; n <= rate.order; ++n) {
    rate.angle[n] = (n + 1) * segment.angle[n + 1];
    rate.partials[n] = (n + 1) * segment.partials[n + 1];
  }
  return rate;
}

/// The rate along a swing [rad s⁻¹⁻ⁿ] as numbers, and as dual numbers if T is dual. Its order is one below the angle's.
template <typename T>
struct RateSeries {
  Series<double> value;
  Series<T> dual;
};

/// Σ coefficient(k) τ^k for k = 0..order. Horner's rule runs separately over even and odd powers, so neither sum waits
/// for the other.
template <typename V, typename Coefficient>
V EvaluatePolynomial(const Coefficient& coefficient, int order, double tau) {
  const double square = tau * tau;
  V odd{};
  V even{};
  if (order % 2 == 0) even = coefficient(order);
  for (int k = order - (order + 1) % 2; k > 0; k -= 2) {
    odd = square * odd + coefficient(k);
    even = square * even + coefficient(k - 1);
  }
  return even + tau * odd;
}

template <typename V>
V EvaluateSeries(const Series<V>& c, int order, double tau) {
  return EvaluatePolynomial<V>([&](int k) { return c[k]; }, order, tau);
}

/// Partial derivatives of EvaluateSeries.
template <DualNumber T>
PartialsFor<T> EvaluatePartials(const Series<T>& c, int order, double tau) {
  return EvaluatePolynomial<PartialsFor<T>>([&](int k) { return c[k].v; }, order, tau);
}

/// Order of the expansion for a local tolerance: 1 - 0.72 ln(tolerance), limited by the size of Series. The asymptotic
/// optimum is 1 - 0.5 ln(tolerance) (Jorba & Zou, Experimental Mathematics 14:99, 2005). The order is higher here
/// because each step has a fixed cost, and locating reversals and evaluating samples are cheaper with fewer, longer
/// steps.
inline int OrderForTolerance(double tolerance) {
  return std::clamp(static_cast<int>(std::ceil(1.0 - 0.72 * std::log(tolerance))), 8, kMaxOrder);
}

/// K numbers without their derivatives.
template <typename T, std::size_t K>
std::array<double, K> Values(const std::array<T, K>& numbers) {
  std::array<double, K> values;
  std::ranges::transform(numbers, values.begin(), [](const T& x) { return Value(x); });
  return values;
}

/// The values of a pendulum's parameters, without derivatives.
template <FrictionModel F, typename T>
Pendulum<F, double> Values(const Pendulum<F, T>& pendulum) {
  return {pendulum.gravity, Value(pendulum.inertia), Values(pendulum.friction)};
}

/// The largest slope of the torque with respect to the angle, in units of the restoring torque G: gravity's is 1.
template <FrictionModel F>
double LargestStiffness(const Pendulum<F, double>& pendulum) {
  if constexpr (FrictionWithState<F>) return 1 + F::Stiffness(pendulum.friction.data());
  return 1;
}

/// The load of the bearing in units of the weight, for a bob on a light rod: 1 - V(θ) + I ω², which is cos θ + I ω²
/// under gravity. MODEL.md eq. (2.11).
template <FrictionModel F, typename T>
double LoadAt(const Pendulum<F, T>& pendulum, double angle, double rate) {
  return 1 - pendulum.gravity.Potential(angle) + Value(pendulum.inertia) * rate * rate;
}

/// Direction of the motion that follows a state: ±1, or 0 if static friction holds the pendulum (MODEL.md eq. (2.9)).
template <FrictionModel F>
double DirectionOfMotion(const Pendulum<F, double>& pendulum, double angle, double rate) {
  if (rate != 0) return rate > 0 ? 1.0 : -1.0;
  const double torque = pendulum.gravity.Torque(angle);
  const double direction = torque > 0 ? -1.0 : 1.0;
  const double holding =
      direction * TorqueUnder<F>(LoadAt(pendulum, angle, 0), 0.0, direction, pendulum.friction.data());
  constexpr double kMargin = 1.0 + 1e-12;  // at equality, rounding must not start a motion
  return std::abs(torque) > holding * kMargin ? direction : 0.0;
}

/// log2 of a positive normal number, accurate to 0.09 and exact for powers of two: the exponent plus the mantissa, as
/// if log2 were linear between powers of two.
inline double RoughLog2(double x) { return static_cast<double>(std::bit_cast<std::int64_t>(x)) * 0x1p-52 - 1023; }

/// Longest step whose truncation error stays near `tolerance` [rad]: the least of (tol / |c_k|)^(1/k) over the last
/// four coefficients, to 2 %, and at most `longest` [s]. Four are used because some vanish after a start from rest or
/// at 90 deg. Returns 0 if a coefficient is not finite.
inline double StepLength(const Series<double>& angle, int order, double tolerance, double longest) {
  double log_step = std::numeric_limits<double>::infinity();
  for (int k = order - 3; k <= order; ++k) {
    const double size = std::abs(angle[k]);
    if (!std::isfinite(size)) return 0.0;
    if (size > 0) log_step = std::min(log_step, (RoughLog2(tolerance) - RoughLog2(size)) * kInverse[k]);
  }
  return std::min(std::exp2(log_step), longest);
}

/// First root in (0, step] of a series, such as the rate, whose sign is `sign` behind the begin of the step; negative
/// if there is none. `end` is its value at the end of the step, whose sign shows whether there is a root: the step must
/// be too short for two. So is a quarter of the small-angle period, within which the rate has at most one. A root at 0,
/// as of the rate in a start from rest, is divided out. Halley's method starts from the chord and stays inside a
/// bisection bracket. It stops after a relative step of 1e-4, because the remaining error is the cube of that.
inline double FirstSignChange(const Series<double>& series, int order, double sign, double step, double end) {
  if (sign * end > 0) return -1;
  const double begin = series[0];
  const int first = begin == 0 ? 1 : 0;
  double low = 0;
  double high = step;
  double root = begin == 0 ? step : step * begin / (begin - end);
  for (int iteration = 0; iteration < 100; ++iteration) {
    double value = series[order];
    double slope = 0;
    double half_bend = 0;
    for (int k = order - 1; k >= first; --k) {
      half_bend = half_bend * root + slope;
      slope = slope * root + value;
      value = value * root + series[k];
    }
    if (value == 0) break;
    (sign * value > 0 ? low : high) = root;
    const double next = root - value * slope / (slope * slope - value * half_bend);
    const bool last = std::abs(next - root) <= 1e-4 * root;
    const bool inside = next > low && next < high;
    root = last || inside ? std::clamp(next, low, high) : 0.5 * (low + high);
    if (last) break;
  }
  return root;
}

/// The instant in (0, step) at which the size of a series of this sign begins to rise after it has fallen, as that of
/// the rate does over the top; negative if there is none.
inline double FirstMinimum(const Series<double>& series, int order, double sign, double step) {
  Series<double> slope{};
  for (int k = 0; k < order; ++k) slope[k] = (k + 1) * series[k + 1];
  if (sign * slope[0] >= 0) return -1;
  return FirstSignChange(slope, order - 1, -sign, step, EvaluateSeries(slope, order - 1, step));
}

/// A step that ends where the rate has a certain value.
struct RatePassage {
  double step = 0;      ///< s
  double end_rate = 0;  ///< rad/s
};

/// The part of a step up to the first special rate of a friction law (HasSpecialRates), or all of it. If the speed
/// falls and rises again within the step, as over the top, a special rate that it falls through lies before the least
/// speed; otherwise one that matters lies between the speeds at the ends. The next part begins at exactly this rate,
/// and so does not end there again.
///
/// The derivatives need no correction, unlike those at a reversal: the motion obeys the same analytic equation before
/// and after the instant, which may therefore be taken as fixed, as the end of any other step.
template <std::size_t K>
RatePassage FirstPassage(const Series<double>& rate, int order, double direction, RatePassage whole,
                         const std::array<double, K>& special_rates) {
  const double begin = direction * rate[0];
  const double least = FirstMinimum(rate, order, direction, whole.step);
  if (least > 0) {
    const double least_rate = EvaluateSeries(rate, order, least);
    const auto is_passed = [&](double special) { return special < begin && special > direction * least_rate; };
    if (std::ranges::any_of(special_rates, is_passed)) whole = {least, least_rate};
  }
  const double end = direction * whole.end_rate;
  double level = end;
  for (const double special : special_rates) {
    const bool passed = begin < end ? special > begin && special < level : special < begin && special > level;
    if (passed) level = special;
  }
  if (level == end) return whole;
  Series<double> distance = rate;
  distance[0] -= direction * level;
  const double side = begin > level ? direction : -direction;
  return {FirstSignChange(distance, order, side, whole.step, whole.end_rate - direction * level), direction * level};
}

/// The state at a reversal, computed from the state at the same instant, whose rate is 0 except for rounding. The rate
/// and its derivatives become 0, and the derivative of the instant is -ω_p / α (implicit function theorem, MODEL.md eq.
/// (4.5)). The time derivatives of angle and friction states are 0 there, so the shift of the instant does not
/// change their partial derivatives.
template <typename T, int K>
State<T, K> StateAtReversal(const State<T, K>& state, double acceleration) {
  State<T, K> reversal = state;
  reversal.rate = T(0.0);
  if constexpr (DualNumber<T>) reversal.time.v -= (1 / acceleration) * state.rate.v;
  return reversal;
}

}  // namespace pendulum
