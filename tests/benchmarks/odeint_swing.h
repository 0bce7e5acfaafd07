// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/algebra/default_operations.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "ceres_users.h"

namespace pendulum::benchmarks {

/// A flat state, which odeint steps fastest: the angle [rad] and its K partial derivatives, then the same for the rate.
template <int K>
using FlatState = std::array<double, 2 * (1 + K)>;

/// Error control by the values only: their accuracy is known, and the derivatives use the same steps.
template <int K>
struct ErrorOfValues {
  double tolerance = 0;  // of a step: rad, rad/s

  template <typename Algebra>
  double error(Algebra& /*algebra*/, const FlatState<K>& /*state*/, const FlatState<K>& /*rates*/,
               const FlatState<K>& error, double /*step*/) const {
    return std::max(std::abs(error[0]), std::abs(error[1 + K])) / tolerance;
  }
};

/// The careful method with a ready-made integrator: Dormand & Prince 5(4) with error control and dense output from
/// Boost.odeint. Reversals are roots of the dense output's rate, and their instants are differentiated by the implicit
/// function theorem. Each half swing starts anew, so dry friction's sign is constant within it. Same interface as
/// LocatedSwing.
template <typename T>
class OdeintSwing {
 public:
  OdeintSwing(double gravity_torque, const T* p)
      : ratios_(gravity_torque, std::array{Carry(p[0]), Carry(p[1]), Carry(p[2])}.data()), angle_(p[3]) {
    Turn(Carry(p[3]));
  }

  /// Advances by a step [s], a double or a T.
  template <typename Step>
  void Advance(const Step& step) {
    elapsed_ += step;
    if (!Reach(Value(elapsed_))) return;
    Flat state;
    stepper_.calc_state(Value(elapsed_), state);
    SetAngle(state);
  }

  const T& angle() const { return angle_; }

 private:
  /// Release time and zero are not in the equation, so only partial derivatives with respect to the other four
  /// parameters are carried.
  static constexpr int kCarried = DualNumber<T> ? 4 : 0;
  using Number = std::conditional_t<DualNumber<T>, ceres::Jet<double, 4>, double>;
  using Flat = FlatState<kCarried>;
  using Method =
      boost::numeric::odeint::runge_kutta_dopri5<Flat, double, Flat, double, boost::numeric::odeint::array_algebra>;
  using Controlled = boost::numeric::odeint::controlled_runge_kutta<Method, ErrorOfValues<kCarried>>;
  using Stepper = boost::numeric::odeint::dense_output_runge_kutta<Controlled>;

  static constexpr int kRate = 1 + kCarried;
  /// Keeps the trajectory within 1e-6 rad of the truth over the reference run.
  static constexpr double kTolerance = 1e-7;
  static constexpr double kFirstStep = 0.05;  // s

  static Number Carry(const T& x) {
    if constexpr (DualNumber<T>) {
      return Number(x.a, x.v.template head<kCarried>());
    } else {
      return x;
    }
  }

  static Number Load(const double* flat) {
    if constexpr (DualNumber<T>) {
      return Number(flat[0], Eigen::Map<const Eigen::Matrix<double, kCarried, 1>>(flat + 1));
    } else {
      return flat[0];
    }
  }

  static void Store(const Number& x, double* flat) {
    flat[0] = Value(x);
    if constexpr (DualNumber<T>) Eigen::Map<Eigen::Matrix<double, kCarried, 1>>(flat + 1) = x.v;
  }

  /// The integrator's time is a double. The derivatives of this instant and of the last reversal are therefore added to
  /// the angle here.
  void SetAngle(const Flat& state) {
    angle_ = T(state[0]);
    if constexpr (DualNumber<T>) {
      angle_.v = state[kRate] * (elapsed_.v - start_.v);
      angle_.v.template head<kCarried>() += Load(state.data()).v;
    }
  }

  Number Acceleration(const Number& angle, const Number& rate) const {
    using std::sin;
    return -(ratios_.gravity * sin(angle) + ratios_.viscous * rate + direction_ * ratios_.coulomb);
  }

  /// Integrates until the dense output covers this time [s]. Returns false at rest.
  bool Reach(double time) {
    while (direction_ != 0 && (time >= reversal_ || time > stepper_.current_time())) {
      if (time >= reversal_) {
        PassReversal();
      } else {
        Step();
      }
    }
    return direction_ != 0;
  }

  void Step() {
    stepper_.do_step([this](const Flat& state, Flat& rates, double /*time*/) {
      std::copy(state.begin() + kRate, state.end(), rates.begin());
      Store(Acceleration(Load(state.data()), Load(state.data() + kRate)), rates.data() + kRate);
    });
    if (direction_ * stepper_.current_state()[kRate] <= 0) LocateReversal();
  }

  /// Finds the zero of the dense output's rate by Newton's method, starting from the chord.
  void LocateReversal() {
    const double before = stepper_.previous_time();
    const double after = stepper_.current_time();
    const double rate_before = stepper_.previous_state()[kRate];
    const double rate_after = stepper_.current_state()[kRate];
    reversal_ = before + (after - before) * rate_before / (rate_before - rate_after);
    Flat state;
    for (int iteration = 0; iteration < 10; ++iteration) {
      stepper_.calc_state(reversal_, state);
      const double change = state[kRate] / Value(Acceleration(Number(state[0]), Number(state[kRate])));
      reversal_ = std::clamp(reversal_ - change, before, after);
      if (std::abs(change) < 1e-12) break;
    }
  }

  void PassReversal() {
    Flat state;
    stepper_.calc_state(reversal_, state);
    const Number angle = Load(state.data());
    if constexpr (DualNumber<T>) {
      const double acceleration = Acceleration(angle, Number(0.0)).a;
      start_.v.template head<kCarried>() -= Load(state.data() + kRate).v / acceleration;
    }
    start_ += reversal_ - Value(start_);
    Turn(angle);
  }

  /// Starts from rest at this angle, in the direction of the pull, unless dry friction holds it.
  void Turn(const Number& angle) {
    const double pull = Value(ratios_.gravity) * std::sin(Value(angle));
    direction_ = std::abs(pull) <= Value(ratios_.coulomb) ? 0.0 : pull > 0 ? -1.0 : 1.0;
    Flat rest{};
    Store(angle, rest.data());
    if (direction_ == 0) SetAngle(rest);
    const double step = stepper_.current_time_step() > 0 ? stepper_.current_time_step() : kFirstStep;
    stepper_.initialize(rest, Value(start_), step);
    reversal_ = std::numeric_limits<double>::infinity();
  }

  Ratios<Number> ratios_;
  T angle_;               // rad
  T elapsed_{0.0};        // s, since the release
  T start_{0.0};          // s, start of this half swing, with its derivatives
  double direction_ = 0;  // of this half swing
  double reversal_ = 0;   // s, start of this half swing, with its derivatives
  Stepper stepper_{Controlled(ErrorOfValues<kCarried>{kTolerance})};
};

}  // namespace pendulum::benchmarks
