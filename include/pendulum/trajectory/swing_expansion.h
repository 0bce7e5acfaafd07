// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/gravity/gravity.h"
#include "pendulum/model/series.h"
#include "pendulum/trajectory/swing.h"

namespace pendulum {

/// Series of the load N of the bearing along a swing, by N' = -ω (3 g + 2 T), from (2.1) and (2.11).
template <typename T>
class LoadSeries {
 public:
  /// The load at the begin, and its sign in the swing.
  void Begin(const T& load, double sign) {
    load_[0] = load;
    sign_ = sign;
  }

  /// Coefficient n of (|N| - 1) times the torque under the weight alone.
  T Torque(int n, const T& under_weight) const { return under_weight * (sign_ * load_[n] - (n == 0 ? 1.0 : 0.0)); }

  /// Finds coefficient n + 1 from coefficients 0..n of the rate and coefficient n of 3 g + 2 T.
  void Continue(int n, const Series<T>& rate, const T& torques) {
    torques_[n] = torques;
    load_[n + 1] = -kInverse[n + 1] * CauchyProduct(rate, torques_, n);
  }

  const Series<T>& load() const { return load_; }
  double sign() const { return sign_; }

 private:
  Series<T> load_{}, torques_{};
  double sign_ = 1;
};

/// The part of a step [s] up to the first root of the load, or all of it. Near the top the load may fall below 0 and
/// rise above it again within a step; then the root lies before its minimum.
inline double UpToNoLoad(const LoadSeries<double>& series, int order, double step) {
  const Series<double>& load = series.load();
  const double sign = series.sign();
  const auto at = [&](double tau) { return EvaluateSeries(load, order, tau); };
  const double least = FirstMinimum(load, order, sign, step);
  const double until = least > 0 && sign * at(least) < 0 ? least : step;
  const double root = FirstSignChange(load, order, sign, until, at(until));
  return root > 0 ? root : step;
}

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
    if constexpr (HasLoad<F>) BeginLoad(from);
    angle_.angle[0] = Value(from.angle);
    rate_.value[0] = Value(from.rate);
    if constexpr (DualNumber<T>) {
      angle_.partials[0] = from.angle.v;
      rate_.dual[0] = from.rate;
    }
    FindAllFor(GravityModels());
  }

  /// The friction states after the pendulum has turned by an angle [rad] since the begin of the expanded swing.
  std::array<T, kFrictionStates<F>> FrictionStatesAfter(const T& travel) const requires FrictionWithState<F> {
    if constexpr (DualNumber<T>) {
      return dual_friction_.StatesAfter(travel);
    } else {
      return friction_.StatesAfter(travel);
    }
  }

  /// The load of the bearing along the expanded swing, to one order below the angle's.
  const LoadSeries<double>& load() const requires HasLoad<F> { return load_; }

 private:
  template <typename U>
  using LoadOf = std::conditional_t<HasLoad<F>, LoadSeries<U>, std::tuple<>>;

  /// Where a step begins with the load 0, the load's slope gives its sign; where it begins at rest too, the load grows.
  void BeginLoad(const StateOf<F, T>& from) {
    constexpr double kNone = 1e-12;
    const double angle = Value(from.angle), rate = Value(from.rate);
    const double* p = values_.friction.data();
    const double load = LoadAt(values_, angle, rate);
    const double gravity = values_.gravity.Torque(angle);
    const double unloaded = F::Torque(rate, direction_, p) - F::LoadTorque(direction_, p);
    const double slope = -rate * (3 * gravity + 2 * unloaded);
    const double sign = (std::abs(load) > kNone ? load : slope) < 0 ? -1 : 1;
    load_.Begin(load, sign);
    if constexpr (DualNumber<T>) {
      const T dual = pendulum_.inertia * from.rate * from.rate;
      dual_load_.Begin(T(load, dual.v - gravity * from.angle.v), sign);
    }
  }

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
    double friction = friction_(n, rate_.value, direction_, values_.friction.data());
    if constexpr (HasLoad<F>) {
      friction += load_.Torque(n, F::LoadTorque(direction_, values_.friction.data()));
      load_.Continue(n, rate_.value, 3 * gravity + 2 * friction);
      if constexpr (DualNumber<T>) torques_ = {gravity, friction};
    }
    rate_.value[n + 1] = (gravity + friction) * per_torque_[n + 1];
  }

  /// Partial derivatives of the next coefficients with respect to the parameters. They follow linear equations: eq.
  /// (4.1) and (4.4), differentiated.
  template <GravityModel L, int n>
  void FindPartials() {
    angle_.partials[n + 1] = kInverse[n + 1] * rate_.dual[n].v;
    if (n + 1 == angle_.order) return;
    const auto gravity = GravitySeries<L>().template PartialsOf<n>(angle_.partials);
    auto friction = dual_friction_(n, rate_.dual, direction_, pendulum_.friction.data()).v;
    if constexpr (HasLoad<F>) {
      friction += dual_load_.Torque(n, F::LoadTorque(direction_, pendulum_.friction.data())).v;
      dual_load_.Continue(n, rate_.dual, T(3 * torques_[0] + 2 * torques_[1], 3 * gravity + 2 * friction));
    }
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
  LoadOf<double> load_;
  LoadOf<T> dual_load_;
  std::array<double, HasLoad<F> ? 2 : 0> torques_;  ///< The last coefficients of the torques of gravity and friction.
};

}  // namespace pendulum
