// SPDX-License-Identifier: Apache-2.0
#include "pendulum/trajectory/trajectory.h"

#include <algorithm>
#include <string>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {

const Segment<double>& Trajectory::SegmentAt(double time) const {
  const auto after = std::upper_bound(segments_.begin(), segments_.end(), time,
                                      [](double t, const Segment<double>& segment) { return t < segment.start; });
  return after == segments_.begin() ? segments_.front() : *(after - 1);
}

double Trajectory::Angle(double time) const {
  const Segment<double>& segment = SegmentAt(time);
  return EvaluateSeries(segment.angle, segment.order, time - segment.start);
}

double Trajectory::Rate(double time) const {
  const Segment<double>& segment = SegmentAt(time);
  const double tau = time - segment.start;
  double rate = 0;
  for (int k = segment.order; k >= 1; --k) rate = rate * tau + k * segment.angle[k];
  return rate;
}

double Trajectory::Acceleration(double time) const {
  const Segment<double>& segment = SegmentAt(time);
  const double tau = time - segment.start;
  double acceleration = 0;
  for (int k = segment.order; k >= 2; --k) acceleration = acceleration * tau + k * (k - 1) * segment.angle[k];
  return acceleration;
}

Result<void> CheckParameters(const MotionModel& model, std::span<const double> parameters) {
  if (parameters.size() != PhysicalParameters(model).size()) {
    return Error(StatusCode::kInvalidArgument, "model " + std::string(model.name) + " takes " +
                                                   std::to_string(PhysicalParameters(model).size()) +
                                                   " parameters, not " + std::to_string(parameters.size()));
  }
  if (parameters[0] > 0) return {};
  return Error(StatusCode::kInvalidArgument, "inertia is " + NumberText(parameters[0]) + "; it must be positive");
}

Result<void> CheckTraced(const TraceSummary& summary) {
  switch (summary.outcome) {
    case TraceSummary::Outcome::kComplete: return {};
    case TraceSummary::Outcome::kNeverMoved:
      return Error(StatusCode::kFailedPrecondition,
                   "friction holds the pendulum where it starts, so it never moves; release it from a larger angle, or "
                   "lower dry friction");
    case TraceSummary::Outcome::kNotTraceable: break;
  }
  return Error(
      StatusCode::kFailedPrecondition,
      "the motion cannot be computed with these parameters, because its time scale is too short for the duration");
}

Result<Trajectory> MakeTrajectory(const MotionModel& model, std::span<const double> parameters,
                                  const Start<double>& start, const TraceOptions& options) {
  RETURN_IF_ERROR(CheckParameters(model, parameters));
  Trajectory trajectory;
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    Pendulum<F, double> pendulum{model.gravity, parameters[0], {}};
    std::copy(parameters.begin() + 1, parameters.end(), pendulum.friction.begin());
    trajectory.set_summary(
        TraceTrajectory(pendulum, start, options, [&](const Segment<double>& segment) { trajectory.Append(segment); }));
  });
  RETURN_IF_ERROR(CheckTraced(trajectory.summary()));
  return trajectory;
}

}  // namespace pendulum
