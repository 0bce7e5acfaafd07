// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "pendulum/base/instruction_set.h"
#include "pendulum/base/status.h"
#include "pendulum/model/dual.h"
#include "pendulum/model/friction/friction_model.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/trajectory/swing.h"

namespace pendulum {

enum class StartKind {
  kRelease,  ///< Held at an angle and released at an instant.
  kMoving,   ///< In motion at the first sample.
};

/// The start of a trajectory: held at `angle` until `time`, or moving through `angle` with `rate` at `time`.
template <typename T>
struct Start {
  StartKind kind = StartKind::kMoving;
  double time = 0;  ///< s. The derivative with respect to a release time is -θ' and needs no dual number.
  T angle, rate;    ///< rad; rad/s, 0 for a release
};

/// Time range and accuracy of a trajectory.
struct TraceOptions {
  double begin = 0, end = 0;  ///< s; segments start at `begin`, at rest until the release.
  double tolerance = 1e-10;   ///< rad, local: the truncation error of one step. See TraceTolerance.
  InstructionSet instruction_set = kInstructionSet;  ///< Must be supported by the processor.
  int max_steps = 2'000'000;  ///< A motion that needs more is not traced: its time scale is too short.
};

/// Summary of a traced motion.
struct TraceSummary {
  enum class Outcome {
    kComplete,
    kNeverMoved,    ///< Friction holds the pendulum at its start.
    kNotTraceable,  ///< A number became infinite, or max_steps was exceeded.
  };
  Outcome outcome = Outcome::kComplete;
  int steps = 0;
  int reversals = 0;
  double stop_time = std::numeric_limits<double>::infinity();  ///< s; when it came to rest permanently.
  double smallest_reversal_margin =
      std::numeric_limits<double>::infinity();  ///< min over reversals of ||g(θ)| - T(0)| / G
};

/// Receives the segments of a trajectory one by one in time order.
template <typename T>
using SegmentVisitor = std::function<void(const Segment<T>&)>;

/// The number type in which a fit of law F traces a released pendulum: derivatives with respect to inertia, friction
/// and angle.
template <typename F>
using ReleaseDual = Dual<kFrictionParameters<F> + 2>;

/// The number type in which a fit of law F traces a moving pendulum: derivatives with respect to inertia, friction, and
/// the angle and rate at the start.
template <typename F>
using MovingDual = Dual<kFrictionParameters<F> + 3>;

/// The number types for which trajectories of law F are compiled.
template <typename T, typename F>
concept TracedWith = std::same_as<T, double> || std::same_as<T, ReleaseDual<F>> || std::same_as<T, MovingDual<F>>;

/// Traces a pendulum from its start to options.end and calls visit(segment) for each piece in time order: the hold, the
/// swings in as many steps as the tolerance requires, and the rest. Reversals are located exactly, so each segment
/// solves one smooth equation. Nothing is stored. MODEL.md section 4. Compiled only for the laws in FrictionModels
/// (src/trajectory/tracer.h). The compilation takes a minute, so the definition is not in this header.
template <FrictionModel F, TracedWith<F> T>
TraceSummary TraceTrajectory(const Pendulum<F, T>& pendulum, const Start<T>& start, const TraceOptions& options,
                             const std::type_identity_t<SegmentVisitor<T>>& visit);

/// A stored trajectory that gives angle, rate and acceleration at any time from options.begin to options.end.
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

/// Whether MakeTrajectory can take these parameters; its kInvalidArgument.
Result<void> CheckParameters(const MotionModel& model, std::span<const double> parameters);

/// Whether a motion was traced to its end; MakeTrajectory's kFailedPrecondition.
Result<void> CheckTraced(const TraceSummary& summary);

/// Traces a model chosen by name. `parameters` are those of PhysicalParameters(model) in units of the restoring torque
/// G. kInvalidArgument: wrong number of parameters, or inertia not positive. kFailedPrecondition: the pendulum never
/// moves, or the motion cannot be traced.
Result<Trajectory> MakeTrajectory(const MotionModel& model, std::span<const double> parameters,
                                  const Start<double>& start, const TraceOptions& options);

}  // namespace pendulum
