// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "pendulum/base/instruction_set.h"
#include "pendulum/base/status.h"
#include "pendulum/trajectory/swing.h"
#include "pendulum/trajectory/swing_expansion.h"

namespace pendulum {

enum class StartKind {
  kRelease,  ///< Held at an angle, released at an instant.
  kMoving,   ///< In motion at the first sample.
};

/// The start of a trajectory: held at `angle` until `time`, or passing `angle` with `rate` at `time`.
template <typename T>
struct Start {
  StartKind kind = StartKind::kMoving;
  double time = 0;  ///< s. The derivative with respect to a release time is -θ' and needs no dual number.
  T angle, rate;    ///< rad; rad/s, 0 for a release
};

/// How far and how accurately to trace.
struct TraceOptions {
  double begin = 0, end = 0;  ///< s; a hold is reported from `begin` to the release.
  double tolerance = 1e-10;   ///< rad, local: the truncation error of one step. See TraceTolerance.
  InstructionSet instruction_set = kInstructionSet;  ///< At most what the processor has.
  int max_steps = 2'000'000;                         ///< Beyond this the trial is refused: its time scale is absurd.
};

/// What happened on the way.
struct TraceSummary {
  enum class Outcome {
    kComplete,
    kNeverMoved,    ///< Friction holds the pendulum at its start.
    kNotTraceable,  ///< A number became infinite, or max_steps was exceeded.
  };
  Outcome outcome = Outcome::kComplete;
  int steps = 0;
  int reversals = 0;
  double stop_time = std::numeric_limits<double>::infinity();  ///< s; when it came to rest for good.
  double smallest_reversal_margin =
      std::numeric_limits<double>::infinity();  ///< min over reversals of ||g(θ)| - T(0)| / G
};

/// Traces a pendulum from its start to options.end and calls visit(const Segment<T>&) for each stretch in time order:
/// the hold, the swings in as many steps as the tolerance asks for, the rest. Reversals are located exactly, so every
/// segment is a true solution of one smooth equation; nothing is stored. MODEL.md section 4.
template <FrictionModel F, typename T, typename Visitor>
TraceSummary TraceTrajectory(const Pendulum<F, T>& pendulum, const Start<T>& start, const TraceOptions& options,
                             Visitor&& visit);

/// A trajectory kept for looking up: dense output at any time between the options' begin and end.
class Trajectory {
 public:
  void Append(const Segment<double>& segment) { segments_.push_back(segment); }

  double Angle(double time) const;         ///< rad, time in s
  double Rate(double time) const;          ///< rad/s
  double Acceleration(double time) const;  ///< rad/s^2
  const TraceSummary& summary() const { return summary_; }
  void set_summary(const TraceSummary& summary) { summary_ = summary; }

 private:
  const Segment<double>& SegmentAt(double time) const;

  std::vector<Segment<double>> segments_;
  TraceSummary summary_;
};

/// Traces a model chosen by name. `parameters` are those of PhysicalParameters(model) in units of G. kInvalidArgument:
/// wrong number of parameters, or inertia not positive. kFailedPrecondition: it never moves, or cannot be traced.
Result<Trajectory> MakeTrajectory(const MotionModel& model, std::span<const double> parameters,
                                  const Start<double>& start, const TraceOptions& options);

template <FrictionModel F, typename T, typename Visitor>
class Tracer {
 public:
  Tracer(const Pendulum<F, T>& pendulum, const TraceOptions& options, Visitor& visit)
      : pendulum_(pendulum),
        values_(Values(pendulum)),
        options_(options),
        order_(OrderForTolerance(options.tolerance)),
        longest_step_(0.5 * kPi * std::sqrt(values_.inertia)),
        visit_(visit) {}

  TraceSummary Run(const Start<T>& start) {
#ifdef PENDULUM_HAS_AVX
    if (options_.instruction_set == InstructionSet::kAvx512) return RunAvx512(start);
    if (options_.instruction_set == InstructionSet::kAvx2) return RunAvx2(start);
#endif
    return RunAnywhere(start);
  }

 private:
#ifdef PENDULUM_HAS_AVX
  [[PENDULUM_AVX2, gnu::flatten]] TraceSummary RunAvx2(const Start<T>& start) { return RunAnywhere(start); }
  [[PENDULUM_AVX512, gnu::flatten]] TraceSummary RunAvx512(const Start<T>& start) { return RunAnywhere(start); }
#endif

  /// The series of a swing but for what visitors see: on the stack, so that the compiler knows who can change it.
  struct Expander {
    RateSeries<T> rate{};
    SwingExpansion<F, T> expansion;

    Expander(const Pendulum<F, T>& pendulum, Segment<T>& segment) : expansion(pendulum, segment, rate) {}
  };

  TraceSummary RunAnywhere(const Start<T>& start) {
    Expander expander(pendulum_, segment_);
    State<T> state{T(start.time), start.angle, start.rate};
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

  double Direction(const State<T>& state) const {
    return DirectionOfMotion(values_, Value(state.angle), Value(state.rate));
  }

  /// Moves `state` to the next reversal, or to the end; false when the trial cannot be traced.
  bool Swing(double direction, State<T>& state, Expander& expander) {
    segment_.order = order_;
    const RateSeries<T>& rate = expander.rate;
    while (Value(state.time) < options_.end) {
      expander.expansion.Expand(direction, state);
      const double step = StepLength(segment_.angle, order_, options_.tolerance, longest_step_);
      if (!(step > 0) || ++summary_.steps > options_.max_steps) {
        summary_.outcome = TraceSummary::Outcome::kNotTraceable;
        return false;
      }
      const double end_rate = EvaluateSeries(rate.value, order_ - 1, step);
      const double root = FirstReversal(rate.value, order_ - 1, direction, step, end_rate);
      const double length = root > 0 ? root : step;
      State<T> next{state.time + length, T(EvaluateSeries(segment_.angle, order_, length)), T(end_rate)};
      if constexpr (DualNumber<T>) {
        next.angle.v = EvaluateSeries(segment_.partials, order_, length);
        next.rate.v = EvaluatePartials(rate.dual, order_ - 1, length);
      }
      VisitSwing(state.time, length);
      state = next;
      if (root > 0) {
        Reverse(direction, state);
        return true;
      }
    }
    return true;
  }

  void Reverse(double direction, State<T>& state) {
    const double gravity = GravityTorque(values_.gravity, Value(state.angle));
    const double torque = gravity + F::Torque(0.0, direction, values_.friction.data());
    state = StateAtReversal(state, -torque / values_.inertia);
    NoteReversal(gravity);
  }

  void VisitSwing(const T& start, double length) {
    segment_.start = Value(start);
    if constexpr (DualNumber<T>) segment_.start_partials = start.v;
    segment_.end = std::min(segment_.start + length, options_.end);
    visit_(std::as_const(segment_));
  }

  /// Between gravity and what would hold the pendulum, were it to go on the other way.
  void NoteReversal(double gravity) {
    ++summary_.reversals;
    const double direction = gravity > 0 ? -1.0 : 1.0;
    const double holding = direction * F::Torque(0.0, direction, values_.friction.data());
    summary_.smallest_reversal_margin =
        std::min(summary_.smallest_reversal_margin, std::abs(std::abs(gravity) - holding));
  }

  /// Rest after a stop: the reading stays, whatever the instant of the stop, for the rate there is 0.
  void RestFrom(const State<T>& state) {
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
  Visitor& visit_;
  Segment<T> segment_;
  TraceSummary summary_;
};

template <FrictionModel F, typename T, typename Visitor>
TraceSummary TraceTrajectory(const Pendulum<F, T>& pendulum, const Start<T>& start, const TraceOptions& options,
                             Visitor&& visit) {
  return Tracer<F, T, Visitor>(pendulum, options, visit).Run(start);
}

}  // namespace pendulum
