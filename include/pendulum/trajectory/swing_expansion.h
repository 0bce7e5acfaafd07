// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <tuple>
#include <utility>

#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/gravity/gravity.h"
#include "pendulum/model/series.h"
#include "pendulum/trajectory/swing.h"

namespace pendulum {

/// Expands swings into Taylor series. Each coefficient depends on the previous one, so the loop over them is unrolled.
/// The processor can then do independent work in between, such as the derivatives.
template <FrictionModel F, typename T>
class SwingExpansion {
 public:
  /// Each call of Expand writes to `angle` and `rate`.
  SwingExpansion(const Pendulum<F, T>& pendulum, Segment<T>& angle, RateSeries<T>& rate)
      : pendulum_(pendulum), values_(Values(pendulum)), angle_(angle), rate_(rate) {
    const double inverse_inertia = 1 / values_.inertia;
    for (int n = 1; n <= kMaxOrder; ++n) per_torque_[n] = -inverse_inertia * kInverse[n];
    if constexpr (DualNumber<T>) inertia_ = inverse_inertia * pendulum.inertia.v;
  }

  /// Coefficients 0..angle.order of the angle and 0..angle.order - 1 of the rate, for one direction of motion from a
  /// state (MODEL.md eq. (4.1)). With a dual T also their partial derivatives.
  void Expand(double direction, const StateOf<F, T>& from) {
    direction_ = direction;
    if constexpr (FrictionWithState<F>) {
      friction_.Begin(Values(from.friction));
      dual_friction_.Begin(from.friction);
    }
    angle_.angle[0] = Value(from.angle);
    rate_.value[0] = Value(from.rate);
    if constexpr (DualNumber<T>) {
      angle_.partials[0] = from.angle.v;
      rate_.dual[0] = from.rate;
    }
    FindAllFor(GravityModels());
  }

  /// The friction states `tau` s after the begin of the expanded swing. The order of their series is one below the
  /// angle's.
  std::array<T, kFrictionStates<F>> FrictionStatesAt(double tau) const requires FrictionWithState<F> {
    if constexpr (DualNumber<T>) {
      return dual_friction_.StatesAt(angle_.order - 1, tau);
    } else {
      return friction_.StatesAt(angle_.order - 1, tau);
    }
  }

 private:
  /// Does not use Gravity::Visit, because its closure would change which products the compiler fuses with sums.
  template <typename... Ls>
  void FindAllFor(GravityModelList<Ls...> /*laws*/) {
    (void)((pendulum_.gravity == Gravity::Of<Ls>() && (FindAll<Ls>(), true)) || ...);
  }

  template <GravityModel L>
  void FindAll() {
    const auto next = [&]<int n>() {
      FindValue<L, n>();
      if constexpr (DualNumber<T>) FindPartials<L, n>();
      return n + 1 < angle_.order;
    };
    [&]<int... n>(std::integer_sequence<int, n...>) { (void)(next.template operator()<n>() && ...); }
    (std::make_integer_sequence<int, kMaxOrder>());
  }

  template <GravityModel L, int n>
  void FindValue() {
    angle_.angle[n + 1] = rate_.value[n] * kInverse[n + 1];
    if (n + 1 == angle_.order) return;
    const double gravity = GravitySeries<L>().template Next<n>(angle_.angle, rate_.value);
    const double friction = friction_(n, rate_.value, direction_, values_.friction.data());
    rate_.value[n + 1] = (gravity + friction) * per_torque_[n + 1];
  }

  /// Partial derivatives of the next coefficients with respect to the parameters. They follow linear equations: eq.
  /// (4.1) and (4.4), differentiated.
  template <GravityModel L, int n>
  void FindPartials() {
    angle_.partials[n + 1] = kInverse[n + 1] * rate_.dual[n].v;
    if (n + 1 == angle_.order) return;
    const auto gravity = GravitySeries<L>().template PartialsOf<n>(angle_.partials);
    const auto friction = dual_friction_(n, rate_.dual, direction_, pendulum_.friction.data()).v;
    const double rate = rate_.value[n + 1];
    const double factor = per_torque_[n + 1];
    const auto known_in_advance = factor * gravity - rate * inertia_;
    rate_.dual[n + 1] = T(rate, known_in_advance + factor * friction);
  }

  template <GravityModel L>
  [[gnu::always_inline]] typename L::template Recurrence<T>& GravitySeries() {
    return std::get<typename L::template Recurrence<T>>(gravity_);
  }

  const Pendulum<F, T>& pendulum_;
  const Pendulum<F, double> values_;
  Series<double> per_torque_{};  ///< -1 / (I n)
  PartialsFor<T> inertia_;       ///< Partials of the inertia, divided by the inertia.
  double direction_ = 1;
  Segment<T>& angle_;
  RateSeries<T>& rate_;
  GravityModels::Recurrences<T> gravity_;
  typename F::template Recurrence<double> friction_;
  typename F::template Recurrence<T> dual_friction_;
};

}  // namespace pendulum
