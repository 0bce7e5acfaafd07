// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <vector>

#include "pendulum/model/parameter.h"
#include "pendulum/model/series.h"

namespace pendulum {

/// A friction law: a type without objects. It gives the torque T(ω) that opposes motion in direction s = ±1. Recurrence
/// gives coefficient n of the Taylor series of that torque along a swing, from coefficients 0..n of the rate. Torque
/// and parameters are in units of the gravity torque G.
///
/// kTitle says in words what the law is; kAbout explains to a beginner where it occurs. kFormula is T as text for the
/// equation of motion in the report: th' is the rate, {name} the value of a parameter.
///
/// Torque(0, 1, p) is the static torque. The pendulum stays at rest while |g(θ)| is at most the static torque for the
/// direction in which it would move.
///
/// Invariants: the law is odd, T(-ω, -s) = -T(ω, s), if parameters that may be negative change their sign too. It never
/// adds energy: T(ω) ω >= 0 for parameters within their bounds. If all torques are 0, there is no friction.
///
/// Some members are optional. kOrdered names a parameter that is never below another. kRateScales or kAngleScales are
/// for a law whose last parameter is a reference, a rate or an angle, on which the torque depends nonlinearly. A search
/// starts from these multiples of the largest rate or angle of the motion. kHasConstantTorque: a part of the torque
/// does not change with the motion; under linear gravity this only shifts the zero. SpecialRates is for a law whose
/// torque changes within a narrow range of rates, see HasSpecialRates. kStates is for a law whose torque depends on the
/// motion so far, see FrictionWithState. LoadTorque is for a law whose torque depends on the load of the bearing, see
/// HasLoad.
template <typename F>
concept FrictionModel = requires(double x, const double* p, const Series<double>& rate,
                                 typename F::template Recurrence<double> recurrence) {
  { F::kName } -> std::convertible_to<std::string_view>;
  { F::kTitle } -> std::convertible_to<std::string_view>;
  { F::kAbout } -> std::convertible_to<std::string_view>;
  { F::kParameters[0] } -> std::convertible_to<ParameterInfo>;
  { F::kFormula } -> std::convertible_to<std::string_view>;
  { F::template Torque<double>(x, x, p) } -> std::same_as<double>;
  { recurrence(0, rate, x, p) } -> std::same_as<double>;
};

template <typename F>
concept HasOrder = requires {
  { F::kOrdered } -> std::convertible_to<OrderedPair>;
};

template <typename F>
concept HasRateScale = requires {
  { F::kRateScales[0] } -> std::convertible_to<double>;
};

template <typename F>
concept HasAngleScale = requires {
  { F::kAngleScales[0] } -> std::convertible_to<double>;
};

/// Whether the last parameter is a reference, on which the torque depends nonlinearly.
template <typename F>
concept HasReference = HasRateScale<F> || HasAngleScale<F>;

/// The number of parameters of a friction law, at compile time.
template <FrictionModel F>
inline constexpr int kFrictionParameters = static_cast<int>(F::kParameters.size());

template <typename F>
concept HasConstantTorque = F::kHasConstantTorque;

/// A law that changes its character at certain rates: far from them the coefficients of the torque's series do not show
/// what happens there, so a long step would pass over it. SpecialRates(p) are these rates [rad/s], positive and
/// increasing, for motion in either direction. A step of a trajectory ends at each of them.
template <typename F>
concept HasSpecialRates = requires(const double* p) {
  { F::SpecialRates(p)[0] } -> std::convertible_to<double>;
};

/// A law with a part that is proportional to the load |N| of the bearing, N = 1 - V(θ) + I ω² in units of the weight
/// (TorqueUnder). LoadTorque(s, p) is this part under the weight alone; Torque contains it.
template <typename F>
concept HasLoad = requires(double x, const double* p) {
  { F::LoadTorque(x, p) } -> std::same_as<double>;
};

/// The torque under a load N. Only a law with HasLoad depends on it.
template <FrictionModel F>
double TorqueUnder(double load, double rate, double direction, const double* p) {
  const double torque = F::Torque(rate, direction, p);
  if constexpr (HasLoad<F>) return torque + (std::abs(load) - 1) * F::LoadTorque(direction, p);
  return torque;
}

template <typename F>
concept HasState = requires {
  { F::kStates } -> std::convertible_to<int>;
};

/// The number of internal states of a friction law, such as the deflection of bristles; 0 for laws of the rate alone.
template <FrictionModel F>
inline constexpr int kFrictionStates = [] {
  if constexpr (HasState<F>) return F::kStates;
  return 0;
}();

/// A friction law with states z that obey z' = ω h(z, s), as those of Dahl, and Canudas de Wit et al. (LuGre), IEEE
/// Trans. Automatic Control 40:419, 1995. It gives some torque at any z, so nothing holds the pendulum: it oscillates
/// on the bristles until the motion is below any resolution. The states and their time derivatives do not jump at a
/// reversal. Torque(ω, s, p) is the torque in steady sliding, which closed forms use. A motion begins with the states
/// of steady sliding: in its direction, or from rest in that in which the pendulum was pulled out.
///
/// - SlidingStates(s): the states in steady sliding.
/// - TorqueAt(z, p): the torque at a reversal, in the direction of positive angles.
/// - Stiffness(p): the largest derivative of the torque with respect to the angle. It limits the duration of a half
///   swing.
/// - Recurrence::Begin(z) begins a swing with these states. Call n of the recurrence also finds coefficient n + 1 of
///   the states. Recurrence::StatesAfter(angle) gives them after the pendulum has turned by an angle.
template <typename F>
concept FrictionWithState = FrictionModel<F> && HasState<F> &&
    requires(double tau, const double* p, std::array<double, F::kStates> z,
             typename F::template Recurrence<double> recurrence) {
  { F::SlidingStates(tau) } -> std::same_as<std::array<double, F::kStates>>;
  { F::TorqueAt(z, p) } -> std::same_as<double>;
  { F::Stiffness(p) } -> std::same_as<double>;
  recurrence.Begin(z);
  { recurrence.StatesAfter(tau) } -> std::same_as<std::array<double, F::kStates>>;
};

/// A closed list of friction laws. Only these can be chosen by name.
template <FrictionModel... Fs>
struct FrictionModelList {
  static_assert(((!HasState<Fs> || FrictionWithState<Fs>)&&...), "a law with kStates has all members of its concept");

  static constexpr std::array<std::string_view, sizeof...(Fs)> kNames = {Fs::kName...};

  /// Calls visit.operator()<F>() for the law called `name`. Returns false if there is none.
  template <typename Visitor>
  static bool Visit(std::string_view name, Visitor&& visit) {
    return ((Fs::kName == name && (visit.template operator()<Fs>(), true)) || ...);
  }

  /// Calls visit.operator()<F>() for every law in list order.
  template <typename Visitor>
  static void ForEach(Visitor&& visit) {
    (visit.template operator()<Fs>(), ...);
  }
};

}  // namespace pendulum
