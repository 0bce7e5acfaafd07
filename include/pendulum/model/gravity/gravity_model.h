// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>

#include "pendulum/model/series.h"

namespace pendulum {

/// A law of gravity: a type without objects. It gives the restoring torque g(θ) in units of the restoring torque G, so
/// g(θ) ≈ θ at small angles. Angles are in rad. Invariants: g is odd, |g'(θ)| <= 1, and g(θ) > 0 for 0 < θ < kTop.
///
/// - kTitle says in words what the law is; kAbout explains to a beginner where it occurs.
/// - kFormula: g as text for the equation of motion; th is the angle.
/// - kIsLinear: whether g is proportional to the angle. Readings in any unit then follow the same equation.
/// - kTop: the angle of the highest point; the torque repeats every 2 kTop. kUnbounded if there is none.
/// - AngleAtTorque: the angle below a quarter turn with this torque, |torque| <= 1.
/// - Potential: the integral of g from 0.
/// - AngleAt: the angle with this torque and this potential.
/// - Chord: the odd function with Chord²/2 = Potential, but accurate at small angles; for a circle, the chord from its
///   lowest point. AngleOfChord is its inverse.
/// - PeriodRatio: the period of a swing without friction, divided by its period at small amplitudes, 0 <= amplitude <
///   kTop.
/// - Recurrence<T>: the Taylor series of g along a swing. Next<n> returns coefficient n from coefficients 0..n of the
///   angle and 0..n-1 of the rate, PartialsOf<n> (T dual) its derivatives from those of the angle. Both are called with
///   n = 0, 1, 2, ... in this order.
template <typename L>
concept GravityModel = requires(double x, const Series<double>& series, typename L::template Recurrence<double> next) {
  { L::kName } -> std::convertible_to<std::string_view>;
  { L::kTitle } -> std::convertible_to<std::string_view>;
  { L::kAbout } -> std::convertible_to<std::string_view>;
  { L::kFormula } -> std::convertible_to<std::string_view>;
  { L::kIsLinear } -> std::convertible_to<bool>;
  { L::kTop } -> std::convertible_to<double>;
  { L::Torque(x) } -> std::same_as<double>;
  { L::AngleAtTorque(x) } -> std::same_as<double>;
  { L::Potential(x) } -> std::same_as<double>;
  { L::AngleAt(x, x) } -> std::same_as<double>;
  { L::Chord(x) } -> std::same_as<double>;
  { L::AngleOfChord(x) } -> std::same_as<double>;
  { L::PeriodRatio(x) } -> std::same_as<double>;
  { next.template Next<0>(series, series) } -> std::same_as<double>;
};

}  // namespace pendulum
