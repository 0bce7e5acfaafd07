// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/series.h"
#include "pendulum/trajectory/swing.h"

namespace pendulum {

/// Expands swings into Taylor series. One coefficient waits for the one before, so the loop over them is unrolled: the
/// processor finds the independent work, among it the derivatives', meanwhile.
template <FrictionModel F, typename T>
class SwingExpansion {
 public:
  /// Writes to `angle` and `rate` on each call.
  SwingExpansion(const Pendulum<F, T>& pendulum, Segment<T>& angle, RateSeries<T>& rate)
      : pendulum_(pendulum),
        values_(Values(pendulum)),
        inverse_inertia_(1 / values_.inertia),
        angle_(angle),
        rate_(rate) {}

  /// Coefficients 0..angle.order of the angle and 0..angle.order - 1 of the rate in one direction of motion from a
  /// state (MODEL.md eq. (12)); with a dual T also their partial derivatives, up to angle.derivative_order.
  void Expand(double direction, const State<T>& from) {
    direction_ = direction;
    angle_.angle[0] = Value(from.angle);
    rate_.value[0] = Value(from.rate);
    if constexpr (DualNumber<T>) {
      angle_.dual[0] = from.angle;
      rate_.dual[0] = from.rate;
    }
    const auto next = [&]<int n>() {
      FindValue<n>();
      if constexpr (DualNumber<T>) {
        if (n < angle_.derivative_order) FindPartials<n>();
      }
      return n + 1 < angle_.order;
    };
    [&]<int... n>(std::integer_sequence<int, n...>) { (void)(next.template operator()<n>() && ...); }
    (std::make_integer_sequence<int, kMaxOrder>());
  }

 private:
  template <int n>
  void FindValue() {
    angle_.angle[n + 1] = rate_.value[n] * kInverse[n + 1];
    if (n + 1 == angle_.order) return;
    const double gravity = IsSine() ? sine_.template Next<n>(angle_.angle[0], rate_.value) : angle_.angle[n];
    const double torque = gravity + friction_(n, rate_.value, direction_, values_.friction.data());
    rate_.value[n + 1] = torque * (inverse_inertia_ * -kInverse[n + 1]);
  }

  /// Linear equations along the swing: (12) and (15), differentiated.
  template <int n>
  void FindPartials() {
    angle_.dual[n + 1].a = angle_.angle[n + 1];
    angle_.dual[n + 1].v = rate_.dual[n].v * kInverse[n + 1];
    if (n + 1 == angle_.derivative_order) return;
    auto torque = IsSine() ? sine_.template Partials<n>(angle_.dual) : angle_.dual[n].v;
    torque += dual_friction_(n, rate_.dual, direction_, pendulum_.friction.data()).v;
    rate_.dual[n + 1].a = rate_.value[n + 1];
    rate_.dual[n + 1].v = inverse_inertia_ * (torque * -kInverse[n + 1] - rate_.value[n + 1] * pendulum_.inertia.v);
  }

  bool IsSine() const { return pendulum_.gravity == Gravity::kSine; }

  const Pendulum<F, T>& pendulum_;
  const Pendulum<F, double> values_;
  const double inverse_inertia_;
  double direction_ = 1;
  Segment<T>& angle_;
  RateSeries<T>& rate_;
  SineSeries sine_;
  typename F::template Recurrence<double> friction_;
  typename F::template Recurrence<T> dual_friction_;
};

}  // namespace pendulum
