// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>

#include <Eigen/Core>
#include <ceres/autodiff_cost_function.h>
#include <ceres/cost_function.h>
#include <ceres/jet.h>

#include "pendulum/model/series.h"
#include "reference_run.h"

/// Code that users of Ceres write without this library. A trajectory advances from sample to sample (here by one
/// Runge-Kutta step, in odeint_swing.h with step size control). It is differentiated automatically with respect to six
/// parameters in one block of fixed size.
namespace pendulum::benchmarks {

/// Gravity, viscous and dry friction over the inertia [1/s^2, 1/s, 1/s^2].
template <typename T>
struct Ratios {
  T gravity;
  T viscous;
  T coulomb;

  Ratios(double gravity_torque, const T* p)
      : gravity(gravity_torque / p[0]), viscous(p[1] / p[0]), coulomb(p[2] / p[0]) {}
};

/// One step of the classical Runge-Kutta method for θ'' = f(θ, θ'), with the sums for θ' written out. `step` [s] is a
/// double or a T.
template <typename T, typename Step, typename Acceleration>
void RungeKuttaStep(const Step& step, const Acceleration& f, T& angle, T& rate) {
  const Step half = 0.5 * step;
  const T k1 = f(angle, rate);
  const T rate2 = rate + half * k1;
  const T k2 = f(angle + half * rate, rate2);
  const T rate3 = rate + half * k2;
  const T k3 = f(angle + half * rate2, rate3);
  const T k4 = f(angle + step * rate3, rate + step * k3);
  angle += step * (rate + step * (k1 + k2 + k3) * (1.0 / 6.0));
  rate += step * (k1 + 2.0 * (k2 + k3) + k4) * (1.0 / 6.0);
}

/// Friction's sign smoothed to tanh(ω / 0.01 rad/s): the simple method.
template <typename T>
class SmoothedSwing {
 public:
  SmoothedSwing(double gravity_torque, const T* p) : ratios_(gravity_torque, p), angle_(p[3]), rate_(0.0) {}

  /// Advances by a step [s], a double or a T.
  template <typename Step>
  void Advance(const Step& step) {
    RungeKuttaStep(
        step,
        [&](const T& angle, const T& rate) {
          using std::sin, std::tanh;
          return -(ratios_.gravity * sin(angle) + ratios_.viscous * rate + ratios_.coulomb * tanh(100.0 * rate));
        },
        angle_, rate_);
  }

  const T& angle() const { return angle_; }

 private:
  Ratios<T> ratios_;
  T angle_;
  T rate_;
};

/// Reversals are located within their step and their instants differentiated by the implicit function theorem. This is
/// the careful method, nearly as accurate as the steps allow.
template <typename T>
class LocatedSwing {
 public:
  LocatedSwing(double gravity_torque, const T* p) : ratios_(gravity_torque, p), angle_(p[3]), rate_(0.0) { Turn(); }

  /// Advances by a step [s], a double or a T.
  template <typename Step>
  void Advance(const Step& step) {
    if (direction_ == 0) return;
    T angle = angle_;
    T rate = rate_;
    RungeKuttaStep(step, Law(), angle, rate);
    if (direction_ * Value(rate) <= 0) return AdvanceThroughReversal(T(step));
    angle_ = angle;
    rate_ = rate;
  }

  const T& angle() const { return angle_; }

 private:
  auto Law() const {
    return [this](const T& angle, const T& rate) {
      using std::sin;
      return -(ratios_.gravity * sin(angle) + ratios_.viscous * rate + direction_ * ratios_.coulomb);
    };
  }

  /// Direction of the motion that starts from rest at this angle.
  void Turn() {
    const double pull = Value(ratios_.gravity) * std::sin(Value(angle_));
    direction_ = std::abs(pull) <= Value(ratios_.coulomb) ? 0.0 : pull > 0 ? -1.0 : 1.0;
  }

  void AdvanceThroughReversal(const T& step) {
    const double since_start = TimeToReversal(Value(step));
    RungeKuttaStep(since_start, Law(), angle_, rate_);
    T reversal(since_start);
    if constexpr (DualNumber<T>) reversal.v = -rate_.v / Law()(angle_, T(0.0)).a;
    rate_ = T(0.0);
    Turn();
    Advance(T(step - reversal));
  }

  /// The length of a step that ends when the rate is 0, by Newton's method in doubles. The first value extrapolates the
  /// present deceleration.
  double TimeToReversal(double step) const {
    const auto law = [&](double angle, double rate) {
      return -(Value(ratios_.gravity) * std::sin(angle) + Value(ratios_.viscous) * rate +
               direction_ * Value(ratios_.coulomb));
    };
    double time = Value(rate_) == 0 ? step : -Value(rate_) / law(Value(angle_), Value(rate_));
    for (int iteration = 0; iteration < 10; ++iteration) {
      double angle = Value(angle_);
      double rate = Value(rate_);
      RungeKuttaStep(time, law, angle, rate);
      const double change = rate / law(angle, rate);
      time -= change;
      if (std::abs(change) < 1e-14) break;
    }
    return time;
  }

  Ratios<T> ratios_;
  T angle_;
  T rate_;
  double direction_ = 0;
};

/// Residuals of a recording, measured - modelled, for ceres::AutoDiffCostFunction, as a typical user writes them.
template <template <typename> typename Swing>
class UsersResiduals {
 public:
  explicit UsersResiduals(const Recording& recording)
      : recording_(recording), gravity_torque_(ReferenceRig().gravity_torque.value) {}

  template <typename T>
  bool operator()(const T* p, T* residuals) const {
    const Eigen::VectorXd& time = recording_.time;
    Swing<T> swing(gravity_torque_, p);
    const T& release_time = p[4];
    for (Eigen::Index i = 0; i < time.size(); ++i) {
      if (time[i] > Value(release_time)) {
        const bool first = i == 0 || time[i - 1] <= Value(release_time);
        if (first) {
          swing.Advance(T(time[i] - release_time));
        } else {
          swing.Advance(time[i] - time[i - 1]);
        }
      }
      residuals[i] = recording_.value[i] - (swing.angle() + p[5]);
    }
    return true;
  }

 private:
  const Recording& recording_;
  double gravity_torque_;
};

/// UsersResiduals with every call inlined, which a typical user does not request. Without it g++ 12 stops inlining
/// early, which costs a sixth more time for a Jacobian in a separate file, and up to three times as much next to other
/// templates.
template <template <typename> typename Swing>
class FlattenedResiduals : public UsersResiduals<Swing> {
 public:
  using UsersResiduals<Swing>::UsersResiduals;

  template <typename T>
  [[gnu::flatten]] bool operator()(const T* p, T* residuals) const {
    return UsersResiduals<Swing>::operator()(p, residuals);
  }
};

/// The cost function over a recording, which must outlive it. Call it once in a file that contains nothing else and is
/// compiled separately. Otherwise other code in the file affects the time.
template <typename Residuals>
std::unique_ptr<ceres::CostFunction> MakeUsersCost(const Recording& recording) {
  return std::make_unique<ceres::AutoDiffCostFunction<Residuals, ceres::DYNAMIC, 6>>(
      new Residuals(recording), static_cast<int>(recording.size()));
}

}  // namespace pendulum::benchmarks
