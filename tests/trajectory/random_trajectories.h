// SPDX-License-Identifier: Apache-2.0
// Trajectories of random pendulums, compared with an independent integrator.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/trajectory/tolerance.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// The rates of change of a law's states, written from its equation.
template <FrictionModel F>
struct StateRates;

template <>
struct StateRates<DahlFriction> {
  static std::array<double, 1> At(const std::array<double, 1>& u, double rate, const double* p) {
    return {(rate - std::abs(rate) * u[0]) / p[2]};
  }
};

/// The motion by Fehlberg's Runge-Kutta method of order 8 from Boost.odeint, with steps of its own: each has an error
/// of 1e-14 and ends at a reversal. Those near the law's narrowest range of rates are too short to pass over it. It
/// uses the law's torque, not its series or its special rates.
template <FrictionModel F>
class ReferenceMotion {
 public:
  ReferenceMotion(const Pendulum<F, double>& pendulum, double angle, double rate)
      : pendulum_(pendulum),
        period_(std::sqrt(pendulum.inertia / LargestStiffness(pendulum))),
        state_{angle, rate},
        step_(1e-3 * period_) {
    if constexpr (HasState<F>) {
      SetStates(F::SlidingStates(std::copysign(1.0, rate != 0 ? rate : angle)));
    }
    direction_ = NextDirection();
    load_sign_ = LoadOf(state_) < -1e-12 ? -1 : 1;
    for (int i = 0; i < kFrictionParameters<F>; ++i) {
      if (F::kParameters[i].unit == "rad/s") range_ = std::min(range_, pendulum.friction[i]);
    }
  }

  /// The angle at a time [s], which is not before that of the last call.
  double AngleAt(double time) {
    while (time_ < time && direction_ != 0) Step(time);
    return state_[0];
  }

 private:
  static constexpr int kStates = kFrictionStates<F>;
  using State = std::array<double, 2 + kStates>;
  using States = std::array<double, kStates>;
  static constexpr double kStepError = 1e-14;  // rad, and rad/s over the natural frequency

  struct Trial {
    State state;
    double error = 0;  ///< In kStepError.
  };

  Trial Try(double step) {
    State next, error;
    method_.do_step(
        [this](const State& state, State& change, double /*time*/) {
          change[0] = state[1];
          change[1] = -(pendulum_.gravity.Torque(state[0]) + FrictionAt(state)) / pendulum_.inertia;
          if constexpr (HasState<F>) {
            const auto rates = StateRates<F>::At(StatesOf(state), state[1], pendulum_.friction.data());
            std::copy(rates.begin(), rates.end(), change.begin() + 2);
          }
        },
        state_, 0.0, next, step, error);
    double largest = std::max(std::abs(error[0]), std::abs(error[1]) * period_);
    for (int k = 0; k < kStates; ++k) largest = std::max(largest, std::abs(error[2 + k]));
    return {next, largest / kStepError};
  }

  static States StatesOf(const State& state) {
    States states;
    std::copy(state.begin() + 2, state.end(), states.begin());
    return states;
  }

  void SetStates(const States& states) { std::copy(states.begin(), states.end(), state_.begin() + 2); }

  double FrictionAt(const State& state) const {
    const double* p = pendulum_.friction.data();
    if constexpr (HasState<F>) {
      return F::Torque(state[1], 1, p) - F::Torque(0.0, 1, p) + F::TorqueAt(StatesOf(state), p);
    }
    const double torque = F::Torque(state[1], direction_, p);
    if constexpr (HasLoad<F>) {
      return torque + (load_sign_ * LoadOf(state) - 1) * F::LoadTorque(direction_, p);
    }
    return torque;
  }

  /// Of the bearing, over the weight.
  double LoadOf(const State& state) const {
    return 1 - pendulum_.gravity.Potential(state[0]) + pendulum_.inertia * state[1] * state[1];
  }

  double NextDirection() const {
    if constexpr (HasState<F>) {
      if (state_[1] != 0) return std::copysign(1.0, state_[1]);
      return -std::copysign(1.0, pendulum_.gravity.Torque(state_[0]) + FrictionAt(state_));
    }
    return DirectionOfMotion(pendulum_, state_[0], state_[1]);
  }

  /// Half of the way to the narrow range, and a fifth of it within. Fehlberg's estimate of the error cannot replace
  /// this: it is blind where the torque depends on time alone, as it nearly does there.
  double LongestStep() const {
    const double longest = (HasLoad<F> ? 0.05 : 0.25) * period_, speed = std::abs(state_[1]);
    if (range_ == kUnbounded) return longest;
    const double friction = FrictionAt(state_);
    const double change = speed < 4 * range_ ? std::abs(FrictionAt({state_[0], 0}) - friction) : 0;
    const double torque = std::abs(pendulum_.gravity.Torque(state_[0]) + friction) + speed * longest + change;
    const double passed = 0.5 * std::max(speed - 8 * range_, 0.0) + 0.2 * range_;
    return std::min(longest, passed * pendulum_.inertia / torque);
  }

  void Step(double end) {
    const double longest = std::min(end - time_, LongestStep());
    double step = std::min(step_, longest);
    Trial trial = Try(step);
    const double change = std::clamp(0.85 * std::pow(trial.error + 1e-300, -1.0 / 8), 0.2, 3.0);
    const bool repeat = trial.error > 1 && step > 1e-9 * period_;
    step_ = step < step_ && !repeat ? std::max(step_, step * change) : step * change;
    if (repeat) return;
    bool turns = direction_ * trial.state[1] <= 0;
    if (turns) {
      step = RootWithin(step, [](const State& state) { return state[1]; });
      trial = Try(step);
      trial.state[1] = 0;
    }
    if (HasLoad<F> && load_sign_ * LoadOf(trial.state) < 0) {  // the step ends where the law has a kink
      step = RootWithin(step, [this](const State& state) { return LoadOf(state); });
      trial = Try(step);
      turns = false;
      load_sign_ = -load_sign_;
    }
    time_ = step == end - time_ ? end : time_ + step;
    state_ = trial.state;
    if (turns) direction_ = NextDirection();
  }

  /// The step [s] after which a quantity of the state is 0; a root at the begin does not count.
  template <typename Quantity>
  double RootWithin(double step, const Quantity& quantity) {
    const auto after = [&](double length) { return quantity(Try(length).state); };
    const double begin = std::abs(quantity(state_)) < 1e-13 ? 1e-6 * step : 0;
    std::uintmax_t most = 100;
    const auto near = boost::math::tools::eps_tolerance<double>(48);
    return boost::math::tools::toms748_solve(after, begin, step, near, most).second;
  }

  const Pendulum<F, double>& pendulum_;
  double period_;  // s; of the small-angle swing, over 2 pi
  State state_;    // rad, rad/s
  double direction_ = 0, load_sign_ = 1;
  double step_;
  double time_ = 0;
  double range_ = kUnbounded;  // rad/s
  boost::numeric::odeint::runge_kutta_fehlberg78<State> method_;
};

/// A pendulum with random friction and a random start, both over several decades. Some turn over the top.
template <FrictionModel F>
struct RandomTrajectory {
  Pendulum<F, double> pendulum;
  Start<double> start;
  double amplitude = 0;  ///< rad; without friction
  double end = 0;        ///< s

  explicit RandomTrajectory(std::mt19937_64& generator) {
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(generator);
    };
    const auto spread = [&](double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); };
    pendulum = {HasLoad<F> || uniform(0, 1) < 0.8 ? Gravity::kSine : Gravity::kLinear, spread(1e-3, 10), {}};
    for (int i = 0; i < kFrictionParameters<F>; ++i) {
      const ParameterInfo& info = F::kParameters[i];
      double value = spread(1e-5, 1);
      if (info.relative_unit == "s") value *= std::sqrt(pendulum.inertia);
      if (info.relative_unit == "s^2") value *= pendulum.inertia;
      if (info.unit == "rad/s") value = spread(1e-6, 100);
      if (info.lower < 0) value = uniform(info.lower, info.upper);
      if (uniform(0, 1) < 0.1) value = info.lower;
      pendulum.friction[i] = std::clamp(value, info.lower, info.upper);
    }
    if constexpr (HasOrder<F>) {
      double &larger = pendulum.friction[F::kOrdered.larger], &smaller = pendulum.friction[F::kOrdered.smaller];
      if (larger < smaller) std::swap(larger, smaller);
    }
    amplitude = spread(0.01, 3.1);
    const bool released = uniform(0, 1) < 0.5;
    const double phase = released ? (uniform(0, 1) < 0.5 ? 0 : kPi) : uniform(-kPi, kPi);
    start.kind = released ? StartKind::kRelease : StartKind::kMoving;
    start.angle = amplitude * std::cos(phase);
    const double energy = pendulum.gravity.Potential(amplitude) - pendulum.gravity.Potential(start.angle);
    start.rate = released ? 0 : std::copysign(std::sqrt(2 * std::max(energy, 0.0) / pendulum.inertia), phase);
    if (!released && uniform(0, 1) < 0.2) start.rate *= spread(1, 3);  // often turns over
    end = spread(1, 46) * 2 * kPi * std::sqrt(pendulum.inertia);
  }

  std::string Text() const {
    std::ostringstream text;
    text.precision(17);
    text << F::kName << " with gravity " << pendulum.gravity.name() << ", inertia " << pendulum.inertia << ", friction";
    for (const double value : pendulum.friction) text << ' ' << value;
    text << ", from " << start.angle << " rad with " << start.rate << " rad/s, for " << end << " s";
    return text.str();
  }
};

/// The angles [rad] at 40 instants; none if the motion cannot be traced.
template <FrictionModel F>
std::vector<double> TracedAngles(const RandomTrajectory<F>& random, const std::vector<double>& instants,
                                 double tolerance) {
  TraceOptions options;
  options.end = random.end;
  options.tolerance = tolerance;
  Trajectory trajectory;
  const TraceSummary summary = TraceTrajectory(random.pendulum, random.start, options,
                                               [&](const Segment<double>& segment) { trajectory.Append(segment); });
  std::vector<double> angles;
  if (summary.outcome == TraceSummary::Outcome::kNotTraceable) return angles;
  const bool never_moved = summary.outcome == TraceSummary::Outcome::kNeverMoved;
  for (const double time : instants) angles.push_back(never_moved ? random.start.angle : trajectory.Angle(time));
  return angles;
}

inline double LargestDifference(const std::vector<double>& x, const std::vector<double>& y) {
  double largest = x.size() == y.size() ? 0 : kUnbounded;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

/// The largest difference [rad] from the reference, at the tolerance for max_error. As in a fit, the tolerance is a
/// hundredth where this changes the angles by more, as it does if the pendulum almost stops at a reversal.
template <FrictionModel F>
double ErrorOf(const RandomTrajectory<F>& random, double max_error) {
  constexpr int kInstants = 40;
  std::vector<double> instants;
  for (int i = 1; i <= kInstants; ++i) instants.push_back(random.end * i / kInstants);
  double tolerance = TraceTolerance(max_error, random.amplitude);
  std::vector<double> angles = TracedAngles(random, instants, tolerance);
  for (int refinement = 0; refinement < 3; ++refinement) {
    tolerance = std::max(1e-2 * tolerance, 1e-17);
    std::vector<double> finer = TracedAngles(random, instants, tolerance);
    if (LargestDifference(angles, finer) <= max_error) break;
    angles = std::move(finer);
  }
  ReferenceMotion<F> reference(random.pendulum, random.start.angle, random.start.rate);
  std::vector<double> expected;
  for (const double time : instants) expected.push_back(reference.AngleAt(time));
  return LargestDifference(angles, expected);
}

/// The descriptions of those of about `count` random trajectories, equally many of each law, whose error is larger than
/// 1e-8 rad.
inline std::vector<std::string> InaccurateTrajectories(int count, std::uint64_t seed) {
  constexpr double kMaxError = 1e-8;  // rad
  const int of_each = count / static_cast<int>(FrictionModels::kNames.size()) + 1;
  std::vector<std::string> inaccurate;
  FrictionModels::ForEach([&]<typename F>() {
    std::mt19937_64 generator(seed);
    for (int i = 0; i < of_each; ++i) {
      const RandomTrajectory<F> random(generator);
      const double error = ErrorOf(random, kMaxError);
      if (!(error <= kMaxError)) inaccurate.push_back(random.Text() + ": " + std::to_string(1e9 * error) + " nrad");
    }
  });
  return inaccurate;
}

}  // namespace pendulum
