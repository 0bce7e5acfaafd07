// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/half_swing_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>
#include <boost/math/quadrature/gauss.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {
namespace {

constexpr int kNodes = 20;
using Nodes = Eigen::Array<double, kNodes, 1>;

/// P_0 to P_kNodes at x by the three-term recurrence.
std::array<double, kNodes + 1> LegendrePolynomials(double x) {
  std::array<double, kNodes + 1> p{1, x};
  for (int n = 1; n < kNodes; ++n) p[n + 1] = ((2 * n + 1) * x * p[n] - n * p[n - 1]) / (n + 1);
  return p;
}

/// Gauss-Legendre nodes x and weights on [-1, 1]. Also integrals from -1 of a function known only at the nodes, from
/// its series Σ (2n + 1) / 2 P_n(x) Σ_j w_j P_n(x_j) f(x_j), term by term.
class Collocation {
 public:
  Collocation() {
    using Gauss = boost::math::quadrature::gauss<double, kNodes>;
    for (int i = 0; i < kNodes / 2; ++i) {
      x[kNodes / 2 + i] = Gauss::abscissa()[i];
      x[kNodes / 2 - 1 - i] = -Gauss::abscissa()[i];
      weight[kNodes / 2 + i] = weight[kNodes / 2 - 1 - i] = Gauss::weights()[i];
    }
    for (int j = 0; j < kNodes; ++j) polynomials_[j] = LegendrePolynomials(x[j]);
    for (int i = 0; i < kNodes; ++i) integrate.row(i) = WeightsTo(x[i]);
  }

  /// The weights that give the integral from -1 to `end` from values at the nodes.
  Eigen::Matrix<double, 1, kNodes> WeightsTo(double end) const {
    const auto at = LegendrePolynomials(end);
    Eigen::Matrix<double, 1, kNodes> weights;
    for (int j = 0; j < kNodes; ++j) {
      double sum = 0.5 * (1 + end);
      for (int n = 1; n < kNodes; ++n) sum += 0.5 * (at[n + 1] - at[n - 1]) * polynomials_[j][n];
      weights[j] = sum * weight[j];
    }
    return weights;
  }

  Nodes x, weight;
  Eigen::Matrix<double, kNodes, kNodes> integrate;  ///< Row i: WeightsTo(x[i]).

 private:
  std::array<std::array<double, kNodes + 1>, kNodes> polynomials_;
};

/// Potential energy in units of the restoring torque G, accurate at small angles.
double PotentialAt(Gravity gravity, double angle) {
  const double chord = gravity.Chord(angle);
  return 0.5 * chord * chord;
}

/// The path from -before to after as θ = m + h sin(π x / 2). Along it the energy and rate / cos(π x / 2) are smooth,
/// including at the turning points.
template <FrictionModel F>
class HalfSwingPath {
 public:
  HalfSwingPath(Gravity gravity, const double* friction, double before, double natural_frequency, double direction)
      : gravity_(gravity),
        friction_(friction),
        before_(before),
        natural_frequency_(natural_frequency),
        direction_(direction) {}

  /// Solves dE/dθ = -T(ω0 sqrt(2 (E - V))) by Picard iteration on the energies at the nodes. `after` follows from the
  /// final energy.
  std::optional<HalfSwingEnd> Solve(bool wants_peak) {
    constexpr int kMaxRounds = 200;
    constexpr double kSame = 4e-15;
    const double energy_before = PotentialAt(gravity_, before_);
    const double highest = PotentialAt(gravity_, gravity_.top());
    Nodes energy = Nodes::Constant(energy_before);
    double after = before_;
    for (int round = 0; round < kMaxRounds; ++round) {
      const Nodes loss = Loss(energy, after);
      energy = energy_before - (Rule().integrate * loss.matrix()).array();
      const double energy_after = energy_before - (Rule().weight * loss).sum();
      if (!(energy_after > 0 && energy_after < highest)) return std::nullopt;
      const double last = std::exchange(after, gravity_.AngleOfChord(std::sqrt(2 * energy_after)));
      if (std::abs(last - after) > kSame * before_) continue;
      HalfSwingEnd end{after, (Rule().weight * slope_ / rate_).sum(), 0, 0};
      if (wants_peak) FindPeak(loss, after, end);
      return end;
    }
    return std::nullopt;
  }

 private:
  static const Collocation& Rule() {
    static const Collocation rule;
    return rule;
  }

  /// The torque that opposes the motion, for both directions.
  double Torque(double angle, double rate) const {
    const double load = 1 - PotentialAt(gravity_, angle) + (rate / natural_frequency_) * (rate / natural_frequency_);
    return direction_ * TorqueUnder<F>(load, direction_ * rate, direction_, friction_);
  }

  double RateAt(double energy, double angle) const {
    const double kinetic = energy - PotentialAt(gravity_, angle);
    return natural_frequency_ * std::sqrt(std::max(2 * kinetic, 1e-30));
  }

  /// T dθ/dx at the nodes; also sets rate_ and slope_.
  Nodes Loss(const Nodes& energy, double after) {
    static const Nodes sine = (kPi / 2 * Rule().x).sin();
    static const Nodes cosine = (kPi / 2 * Rule().x).cos();
    const double half = 0.5 * (before_ + after);
    slope_ = half * kPi / 2 * cosine;
    Nodes loss;
    for (int i = 0; i < kNodes; ++i) {
      const double angle = 0.5 * (after - before_) + half * sine[i];
      rate_[i] = RateAt(energy[i], angle);
      loss[i] = Torque(angle, rate_[i]) * slope_[i];
    }
    return loss;
  }

  /// The rate is largest where the torques of gravity and friction cancel. A few rounds suffice, because the friction
  /// torque hardly changes there.
  void FindPeak(const Nodes& loss, double after, HalfSwingEnd& end) const {
    constexpr int kMaxRounds = 50;
    constexpr double kSame = 1e-13;
    const double middle = 0.5 * (after - before_);
    const double half = 0.5 * (before_ + after);
    double angle = 0;
    double x = 0;
    double rate = 0;
    for (int round = 0; round < kMaxRounds; ++round) {
      x = 2 / kPi * std::asin(std::clamp((angle - middle) / half, -1.0, 1.0));
      rate = RateAt(PotentialAt(gravity_, before_) - Rule().WeightsTo(x).dot(loss.matrix()), angle);
      const double torque = std::clamp(Torque(angle, rate), -1.0, 1.0);
      const double last = std::exchange(angle, -gravity_.AngleAtTorque(torque));
      if (std::abs(last - angle) <= kSame * half) break;
    }
    end.peak_rate = rate;
    end.peak_delay = Rule().WeightsTo(x).dot((slope_ / rate_).matrix());  // dt/dx
  }

  Gravity gravity_;
  const double* friction_;
  double before_, natural_frequency_, direction_;
  Nodes rate_, slope_;  // ω and dθ/dx at the nodes
};

}  // namespace

std::optional<HalfSwingEnd> ComputeHalfSwing(const MotionModel& model, std::span<const double> friction,
                                             double amplitude, double natural_frequency, double direction,
                                             bool wants_peak) {
  std::optional<HalfSwingEnd> end;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    end = HalfSwingPath<F>(model.gravity, friction.data(), amplitude, natural_frequency, direction).Solve(wants_peak);
  });
  return end;
}

}  // namespace pendulum
