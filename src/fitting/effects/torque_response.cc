// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/torque_response.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

using Eigen::Index;

using Changes = std::array<double, kDisturbances>;

/// δ and δ' of all disturbances.
struct DisturbedState {
  Changes angle{}, rate{};
};

/// The law about which the motion is linearized.
class LinearizedLaw {
 public:
  LinearizedLaw(const MotionModel& model, std::span<const double> physical)
      : gravity_(model.gravity), inertia_(physical[0]), friction_(physical.begin() + 1, physical.end()) {
    FrictionModels::Visit(model.friction, [&]<typename F>() { torque_ = &TorqueUnder<F>; });
  }

  double inertia() const { return inertia_; }

  /// Friction with a state is taken as in steady sliding.
  double FrictionTorque(double angle, double rate, double direction) const {
    return torque_(1 - gravity_.Potential(angle) + inertia_ * rate * rate, rate, direction, friction_.data());
  }

  /// ∂T/∂ω within one direction of motion. `scale` is a small rate.
  double FrictionSlope(double angle, double rate, double direction, double scale) const {
    const double step = direction * 1e-3 * scale;
    return (FrictionTorque(angle, rate + step, direction) - FrictionTorque(angle, rate, direction)) / step;
  }

  double GravitySlope(double angle) const {
    constexpr double kStep = 1e-5;
    return (gravity_.Torque(angle + kStep) - gravity_.Torque(angle - kStep)) / (2 * kStep);
  }

  /// The ratio of the accelerations after and before a reversal that ends motion in a direction.
  double AccelerationRatio(double angle, double direction) const {
    const double gravity = gravity_.Torque(angle);
    const double before = gravity + FrictionTorque(angle, 0, direction);
    const double after = gravity + FrictionTorque(angle, 0, -direction);
    return before != 0 ? after / before : 1;
  }

 private:
  Gravity gravity_;
  double (*torque_)(double load, double rate, double direction, const double* parameters) = nullptr;
  double inertia_;
  std::vector<double> friction_;
};

/// A motion between two samples: Hermite polynomials through both angles, rates and accelerations.
class BetweenSamples {
 public:
  BetweenSamples(const Eigen::VectorXd& time, const MotionStates& states, Index i)
      : begin_(time[i]),
        length_(time[i + 1] - time[i]),
        angle_{states.value[0][i], states.value[0][i + 1]},
        rate_{states.value[1][i], states.value[1][i + 1]},
        acceleration_{states.value[2][i], states.value[2][i + 1]} {}

  double Angle(double time) const { return At(time, angle_, rate_); }
  double Rate(double time) const { return At(time, rate_, acceleration_); }

 private:
  double At(double time, const std::array<double, 2>& value, const std::array<double, 2>& slope) const {
    const double u = (time - begin_) / length_;
    const double v = 1 - u;
    return v * v * (1 + 2 * u) * value[0] + u * u * (1 + 2 * v) * value[1] +
           length_ * u * v * (v * slope[0] - u * slope[1]);
  }

  double begin_, length_;
  std::array<double, 2> angle_, rate_, acceleration_;
};

/// The coefficients of the linearized equation at one instant.
struct LinearizedInstant {
  double stiffness, damping;
  Changes forcing;
};

/// Steps δ through the recording.
class DisturbanceIntegrator {
 public:
  DisturbanceIntegrator(const LinearizedLaw& law, const SwingSize& size) : law_(law), size_(size) {
    state_.rate[static_cast<int>(Disturbance::kPush)] = 1;
  }

  const DisturbedState& state() const { return state_; }

  /// From `begin` to `end`, which lie between two samples.
  void Follow(const BetweenSamples& motion, double begin, double end) {
    constexpr double kStepsPerPeriod = 40;
    const double longest = 2 * kPi * std::sqrt(law_.inertia()) / kStepsPerPeriod;
    const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / longest)));
    const double step = (end - begin) / steps;
    for (int n = 0; n < steps; ++n) Step(motion, begin + n * step, step);
  }

 private:
  /// A step ends at a reversal, and the rest of it goes on from there.
  void Step(const BetweenSamples& motion, double time, double step) {
    if (direction_ == 0) direction_ = motion.Rate(time + step) < 0 ? -1 : 1;
    if (motion.Rate(time + step) * direction_ >= 0) return Advance(motion, time, step);
    const double until = Reversal(motion, time, step);
    Advance(motion, time, until);
    const double ratio = law_.AccelerationRatio(motion.Angle(time + until), direction_);
    for (double& r : state_.rate) r *= ratio;
    direction_ = -direction_;
    travel_ = 0;
    Advance(motion, time + until, step - until);
  }

  /// The part of a step after which the rate vanishes, to a thousandth of the step.
  double Reversal(const BetweenSamples& motion, double time, double step) const {
    double low = 0, high = step;
    for (int halving = 0; halving < 10; ++halving) {
      const double middle = 0.5 * (low + high);
      (motion.Rate(time + middle) * direction_ > 0 ? low : high) = middle;
    }
    return high;
  }

  /// Within one direction of motion.
  void Advance(const BetweenSamples& motion, double time, double step) {
    const LinearizedInstant first = LinearizedAt(motion, time);
    const double half = 0.5 * step;
    travel_ += std::abs(motion.Angle(time + half) - motion.Angle(time));
    const LinearizedInstant middle = LinearizedAt(motion, time + half);
    travel_ += std::abs(motion.Angle(time + step) - motion.Angle(time + half));
    TakeRungeKutta(first, middle, LinearizedAt(motion, time + step), step);
  }

  LinearizedInstant LinearizedAt(const BetweenSamples& motion, double time) const {
    const double rate = motion.Rate(time);
    const double angle = motion.Angle(time);
    const double inverse = 1 / law_.inertia();
    LinearizedInstant at{inverse * law_.GravitySlope(angle),
                         inverse * law_.FrictionSlope(angle, rate, direction_, size_.rate),
                         TorquesAt({angle, rate, direction_, travel_}, size_)};
    for (double& torque : at.forcing) torque *= -inverse;
    return at;
  }

  void TakeRungeKutta(const LinearizedInstant& first, const LinearizedInstant& middle, const LinearizedInstant& last,
                      double step) {
    for (std::size_t k = 0; k < kDisturbances; ++k) {
      const auto acceleration = [k](const LinearizedInstant& at, double angle, double rate) {
        return at.forcing[k] - at.stiffness * angle - at.damping * rate;
      };
      const double x = state_.angle[k];
      const double v = state_.rate[k];
      const double a1 = acceleration(first, x, v);
      const double v2 = v + 0.5 * step * a1;
      const double a2 = acceleration(middle, x + 0.5 * step * v, v2);
      const double v3 = v + 0.5 * step * a2;
      const double a3 = acceleration(middle, x + 0.5 * step * v2, v3);
      const double v4 = v + step * a3;
      const double a4 = acceleration(last, x + step * v3, v4);
      state_.angle[k] = x + step / 6 * (v + 2 * v2 + 2 * v3 + v4);
      state_.rate[k] = v + step / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
  }

  const LinearizedLaw& law_;
  SwingSize size_;
  DisturbedState state_;
  double direction_ = 0;
  double travel_ = 0;
};

void SetRow(const Changes& changes, Index row, Eigen::MatrixXd& matrix) {
  for (int k = 0; k < kDisturbances; ++k) matrix(row, k) = changes[static_cast<std::size_t>(k)];
}

}  // namespace

std::array<double, kDisturbances> TorquesAt(const SwingInstant& instant, const SwingSize& size) {
  constexpr double kNarrow = 0.1, kWide = 0.35;  // of the largest rate
  constexpr double kShort = 0.05, kLong = 0.2;   // of the largest angle
  const double s = instant.direction;
  const double rate = instant.rate / size.rate;
  const double angle = instant.angle / size.angle;
  const double travel = instant.travel / size.angle;
  const auto stick = [&](double width) { return s * std::exp(-(rate / width) * (rate / width)); };
  return {s,
          s * rate * rate,
          stick(kNarrow),
          stick(kWide),
          1,
          s * angle,
          s * angle * angle,
          s * std::exp(-travel / kShort),
          s * std::exp(-travel / kLong),
          0};
}

DisturbedMotion RespondToDisturbances(const Eigen::VectorXd& time, const MotionStates& states, double begin, double end,
                                      const MotionModel& model, std::span<const double> physical) {
  const Index samples = time.size();
  DisturbedMotion response{Eigen::MatrixXd::Zero(samples, kDisturbances),
                           Eigen::MatrixXd::Zero(samples, kDisturbances)};
  const LinearizedLaw law(model, physical);
  DisturbanceIntegrator integrator(law, {states.value[0].cwiseAbs().maxCoeff(), states.value[1].cwiseAbs().maxCoeff()});
  if (time[0] >= begin) SetRow(integrator.state().rate, 0, response.rate);
  for (Index i = 0; i + 1 < samples; ++i) {
    const double from = std::max(time[i], begin);
    const double to = std::min(time[i + 1], end);
    if (from < to) integrator.Follow(BetweenSamples(time, states, i), from, to);
    if (time[i + 1] < begin) continue;
    SetRow(integrator.state().angle, i + 1, response.angle);
    if (time[i + 1] < end) SetRow(integrator.state().rate, i + 1, response.rate);
  }
  return response;
}

}  // namespace pendulum
