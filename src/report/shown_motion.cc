// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/shown_motion.h"

#include <algorithm>
#include <cmath>

#include "pendulum/analysis/fitted_motion.h"

namespace pendulum {

bool HidesMotion(const IdentifiedRecording& recording) {
  constexpr double kFewPerPeriod = 12;
  if (recording.used.quantity != Quantity::kAngle) return true;
  if (!recording.sampling) return false;
  const double per_period = recording.sampling->samples_per_period;  // 0: unknown
  return recording.sampling->gaps > 0 || (per_period > 0 && per_period < kFewPerPeriod);
}

std::optional<ShownMotion> MotionToShow(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig,
                                        double max_steps) {
  constexpr double kPointsPerPeriod = 60;  // straight lines between them are off by at most 0.14 % of the amplitude
  if (fit.termination == Termination::kFailed || fit.parameters.empty()) return std::nullopt;
  const double first = used.time[0], last = used.time[used.size() - 1];
  const ParameterEstimate* const release = fit.Find(kReleaseTime.name);
  const double start = release == nullptr ? first : std::max(first, release->estimate);
  const FittedMotion motion(used, fit, rig);
  const std::optional<Trajectory> trajectory = motion.Trace();
  if (!trajectory || !(start < last)) return std::nullopt;
  const double duration = used.clock_scale * (last - start);  // true s
  const double steps = std::ceil(std::min(max_steps, kPointsPerPeriod * duration / motion.small_angle_period()));
  const double from_first = used.clock_scale * (start - first);
  const Eigen::VectorXd instants =
      Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(steps) + 1, from_first, from_first + duration);
  ShownMotion shown{start, (last - start) / steps, {}, {}, motion.Readings(instants).value_or(Eigen::VectorXd())};
  shown.angle = instants.unaryExpr([&](double t) { return trajectory->Angle(t); });
  shown.rate = instants.unaryExpr([&](double t) { return trajectory->Rate(t); });
  return shown;
}

}  // namespace pendulum
