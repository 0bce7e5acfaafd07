// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

#include "pendulum/base/instruction_set.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/trajectory/swing.h"
#include "pendulum/trajectory/swing_expansion.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// Executes one call of TraceTrajectory.
template <FrictionModel F, TracedWith<F> T>
class Tracer {
 public:
  Tracer(const Pendulum<F, T>& pendulum, const TraceOptions& options, const SegmentVisitor<T>& visit)
      : pendulum_(pendulum),
        values_(Values(pendulum)),
        options_(options),
        order_(OrderForTolerance(options.tolerance)),
        longest_step_(0.5 * kPi * std::sqrt(values_.inertia / LargestStiffness(values_))),
        rate_tolerance_(kRateShare * options.tolerance / longest_step_),
        visit_(visit) {}

  TraceSummary Run(const Start<T>& start) {
#ifdef PENDULUM_HAS_AVX
    if (options_.instruction_set == InstructionSet::kAvx512) return RunAvx512(start);
    if (options_.instruction_set == InstructionSet::kAvx2) return RunAvx2(start);
#endif
    return RunGeneric(start);
  }

 private:
  /// The error of the rate grows with 1 / step. With most laws a step takes a good part of a swing, and the tolerance
  /// of the angle limits both. Where a law changes quickly, steps are short, and the rate has a tolerance of its own:
  /// its error lasts for the rest of the swing.
  static constexpr bool kHasShortSteps = HasSpecialRates<F> || FrictionWithState<F>;
  static constexpr double kRateShare = 3;

#ifdef PENDULUM_HAS_AVX
  [[PENDULUM_AVX2, gnu::flatten]] TraceSummary RunAvx2(const Start<T>& start) { return RunGeneric(start); }
  [[PENDULUM_AVX512, gnu::flatten]] TraceSummary RunAvx512(const Start<T>& start) { return RunGeneric(start); }
#endif

  /// The series of a swing, except the segment that visitors see. They are on the stack, so the compiler knows that
  /// nothing else changes them.
  struct Expander {
    RateSeries<T> rate{};
    SwingExpansion<F, T> expansion;

    Expander(const Pendulum<F, T>& pendulum, Segment<T>& segment) : expansion(pendulum, segment, rate) {}
  };

  TraceSummary RunGeneric(const Start<T>& start) {
    Expander expander(pendulum_, segment_);
    StateOf<F, T> state{T(start.time), start.angle, start.rate};
    if constexpr (FrictionWithState<F>) {
      const double last = Value(start.rate) != 0 ? Value(start.rate) : Value(start.angle);
      std::ranges::transform(F::SlidingStates(std::copysign(1.0, last)), state.friction.begin(),
                             [](double x) { return T(x); });
    }
    if (start.kind == StartKind::kRelease && start.time > options_.begin)
      VisitRest(options_.begin, start.time, start.angle);
    double direction = Direction(state);
    if (direction == 0) summary_.outcome = TraceSummary::Outcome::kNeverMoved;
    while (direction != 0 && Value(state.time) < options_.end) {
      if (!Swing(direction, state, expander)) return summary_;
      direction = Direction(state);
    }
    if (direction == 0) {
      summary_.stop_time = Value(state.time);
      RestFrom(state);
    }
    return summary_;
  }

  double Direction(const StateOf<F, T>& state) const {
    if constexpr (FrictionWithState<F>) {
      if (Value(state.rate) != 0) return std::copysign(1.0, Value(state.rate));
      const double torque = values_.gravity.Torque(Value(state.angle)) + FrictionAtReversal(0, state);
      return torque > 0 ? -1.0 : torque < 0 ? 1.0 : 0.0;
    } else {
      return DirectionOfMotion(values_, Value(state.angle), Value(state.rate));
    }
  }

  /// The friction torque at a reversal that ends motion in a direction, in units of the restoring torque G.
  double FrictionAtReversal([[maybe_unused]] double direction, [[maybe_unused]] const StateOf<F, T>& state) const {
    if constexpr (FrictionWithState<F>) {
      return F::TorqueAt(Values(state.friction), values_.friction.data());
    } else {
      const double load = LoadAt(values_, Value(state.angle), 0);
      return TorqueUnder<F>(load, 0.0, direction, values_.friction.data());
    }
  }

  /// Moves `state` to the next reversal or to the end. Returns false if the motion cannot be traced.
  bool Swing(double direction, StateOf<F, T>& state, Expander& expander) {
    segment_.order = order_;
    const RateSeries<T>& rate = expander.rate;
    while (Value(state.time) < options_.end) {
      expander.expansion.Expand(direction, state);
      double step = StepLength(segment_.angle, order_, options_.tolerance, longest_step_);
      if constexpr (kHasShortSteps) step = StepLength(rate.value, order_ - 1, rate_tolerance_, step);
      if (!(step > 0) || ++summary_.steps > options_.max_steps) {
        summary_.outcome = TraceSummary::Outcome::kNotTraceable;
        return false;
      }
      const auto [whole, end_rate] = UpToChange(direction, step, expander);
      const double root = FirstSignChange(rate.value, order_ - 1, direction, whole, end_rate);
      const double length = root > 0 ? root : whole;
      StateOf<F, T> next{state.time + length, T(EvaluateSeries(segment_.angle, order_, length)), T(end_rate)};
      if constexpr (DualNumber<T>) {
        next.angle.v = EvaluateSeries(segment_.partials, order_, length);
        next.rate.v = EvaluatePartials(rate.dual, order_ - 1, length);
      }
      if constexpr (FrictionWithState<F>)
        next.friction = expander.expansion.FrictionStatesAfter(next.angle - state.angle);
      VisitSwing(state.time, length);
      state = next;
      if (root > 0) {
        Reverse(direction, state);
        return true;
      }
    }
    return true;
  }

  /// The part of a step up to the first instant at which the law changes its character, or all of it.
  RatePassage UpToChange(double direction, double step, const Expander& expander) const {
    const Series<double>& rate = expander.rate.value;
    if constexpr (HasLoad<F>) step = UpToNoLoad(expander.expansion.load(), order_ - 1, step);
    const RatePassage whole = {step, EvaluateSeries(rate, order_ - 1, step)};
    if constexpr (HasSpecialRates<F>) {
      return FirstPassage(rate, order_ - 1, direction, whole, F::SpecialRates(values_.friction.data()));
    }
    return whole;
  }

  void Reverse(double direction, StateOf<F, T>& state) {
    const double gravity = values_.gravity.Torque(Value(state.angle));
    const double torque = gravity + FrictionAtReversal(direction, state);
    state = StateAtReversal(state, -torque / values_.inertia);
    RecordReversal(gravity, Value(state.angle));
  }

  void VisitSwing(const T& start, double length) {
    segment_.start = Value(start);
    if constexpr (DualNumber<T>) segment_.start_partials = start.v;
    segment_.end = std::min(segment_.start + length, options_.end);
    visit_(std::as_const(segment_));
  }

  /// Counts a reversal. The margin is the difference between gravity and the friction that could hold the pendulum
  /// there. Friction with states cannot hold the pendulum.
  void RecordReversal(double gravity, double angle) {
    ++summary_.reversals;
    if constexpr (FrictionWithState<F>) return;
    const double direction = gravity > 0 ? -1.0 : 1.0;
    const double holding =
        direction * TorqueUnder<F>(LoadAt(values_, angle, 0), 0.0, direction, values_.friction.data());
    summary_.smallest_reversal_margin =
        std::min(summary_.smallest_reversal_margin, std::abs(std::abs(gravity) - holding));
  }

  /// Rest after a stop. The partials of the angle need no correction for the instant of the stop, because the rate
  /// there is 0.
  void RestFrom(const StateOf<F, T>& state) {
    if (Value(state.time) < options_.end) VisitRest(Value(state.time), options_.end, state.angle);
  }

  void VisitRest(double start, double end, const T& angle) {
    segment_.start = start;
    segment_.start_partials = {};
    segment_.end = std::min(end, options_.end);
    segment_.order = 0;
    segment_.angle[0] = Value(angle);
    if constexpr (DualNumber<T>) segment_.partials[0] = angle.v;
    visit_(std::as_const(segment_));
  }

  const Pendulum<F, T>& pendulum_;
  const Pendulum<F, double> values_;
  const TraceOptions& options_;
  const int order_;
  const double longest_step_;
  const double rate_tolerance_;
  const SegmentVisitor<T>& visit_;
  Segment<T> segment_;
  TraceSummary summary_;
};

template <FrictionModel F, TracedWith<F> T>
TraceSummary TraceTrajectory(const Pendulum<F, T>& pendulum, const Start<T>& start, const TraceOptions& options,
                             const std::type_identity_t<SegmentVisitor<T>>& visit) {
  return Tracer<F, T>(pendulum, options, visit).Run(start);
}

/// Takes the address of TraceTrajectory for every law with the number type TypeOf<F>. A file that defines a variable of
/// this type compiles all of these functions. Each number type has its own file, because these functions take the
/// longest to compile.
template <template <typename F> typename TypeOf, typename Models = FrictionModels>
struct TracersOfAllLaws;

template <template <typename F> typename TypeOf, typename... Fs>
struct TracersOfAllLaws<TypeOf, FrictionModelList<Fs...>> {
  std::tuple<decltype(&TraceTrajectory<Fs, TypeOf<Fs>>)...> functions{&TraceTrajectory<Fs, TypeOf<Fs>>...};
};

}  // namespace pendulum
