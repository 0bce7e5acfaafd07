// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <string_view>
#include <vector>

#include "pendulum/model/parameter.h"
#include "pendulum/model/series.h"

namespace pendulum {

/// A friction law: a type without objects. It names itself and its parameters, says in words what it is (kTitle) and
/// where it is met (kAbout, for who has never heard of it), gives the torque T(ω) that opposes
/// motion in direction s = ±1, and coefficient n of that torque's Taylor series along a swing, from the rate's
/// coefficients 0..n. kFormula is T as text for the report's equation of motion: th' is the rate, {name} the value of a
/// parameter. Torque and parameters are in units of the gravity torque G. Torque(0, 1, p) is the static torque: the
/// pendulum stays at rest while |sin θ| does not exceed it, that of the direction in which it would move. The law is
/// odd, T(-ω, -s) = -T(ω, s), but for parameters of either sign, which change theirs; it never adds energy, T(ω) ω >=
/// 0, for parameters within their bounds; all torques 0 is no friction. Two members may be left out: kOrdered, a
/// parameter that is never below another; kRateScales, where the last parameter is a rate that the torque is not linear
/// in: the multiples of the largest rate from which a search begins.
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

/// The number of parameters of a friction law, at compile time.
template <FrictionModel F>
inline constexpr int kFrictionParameters = static_cast<int>(F::kParameters.size());

/// A closed list of friction laws: what can be chosen by name is what stands in it.
template <FrictionModel... Fs>
struct FrictionModelList {
  static constexpr std::array<std::string_view, sizeof...(Fs)> kNames = {Fs::kName...};

  /// Calls visit.operator()<F>() for the law of that name; false when there is none.
  template <typename Visitor>
  static bool Visit(std::string_view name, Visitor&& visit) {
    return ((Fs::kName == name && (visit.template operator()<Fs>(), true)) || ...);
  }

  /// Calls visit.operator()<F>() for every law, in the order of the list.
  template <typename Visitor>
  static void ForEach(Visitor&& visit) {
    (visit.template operator()<Fs>(), ...);
  }
};

}  // namespace pendulum
