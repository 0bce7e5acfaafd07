// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/fitted_motion.h"

#include <cmath>
#include <memory>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"

namespace pendulum {

FittedMotion::FittedMotion(const Recording& used, const FitReport& fit, const std::optional<Rig>& rig,
                           std::stop_token stop)
    : model_(fit.model), start_(fit.start), quantity_(fit.quantity), sensor_(fit.sensor), stop_(std::move(stop)) {
  instants_ = used.clock_scale * (used.time.array() - used.time[0]);
  if (fit.Find(kHysteresis.name) != nullptr) against_ = ZeroMotionFactors(used, instants_, ZeroMotion::kLags);
  const double gravity_torque = rig ? rig->gravity_torque.value : 1.0;
  for (const ParameterEstimate& parameter : fit.parameters) {
    const std::string_view name = parameter.info.name;
    const bool is_release = name == kReleaseTime.name;
    if (name == kZeroDrift.name || name == kBiasDrift.name) zero_motion_ = ZeroMotion::kDrifts;
    if (name == kHysteresis.name) zero_motion_ = ZeroMotion::kLags;
    reported_.push_back(is_release                             ? 1 / used.clock_scale
                        : parameter.info.scales_with_gravity() ? gravity_torque
                                                               : 1.0);
    offset_.push_back(is_release ? used.time[0] : 0.0);
    parameters_.push_back((parameter.estimate - offset_.back()) / reported_.back());
  }
}

double FittedMotion::small_angle_period() const { return 2 * kPi * std::sqrt(parameters_[0]); }

FittedMotion FittedMotion::WithGravity(Gravity gravity) const {
  FittedMotion motion = *this;
  motion.model_.gravity = gravity;
  return motion;
}

FittedMotion FittedMotion::WithoutDrift() const {
  FittedMotion motion = *this;
  if (drifts()) motion.parameters_.back() = 0;
  return motion;
}

FittedMotion FittedMotion::WithValues(const std::vector<double>& values) const {
  FittedMotion motion = *this;
  for (std::size_t i = 0; i < values.size(); ++i) motion.parameters_[i] = (values[i] - offset_[i]) / reported_[i];
  return motion;
}

FittedMotion FittedMotion::WithViscous(double inertia, double viscous) const {
  FittedMotion motion = *this;
  const auto friction_end = static_cast<std::ptrdiff_t>(PhysicalParameters(model_).size());
  motion.model_.friction = "viscous";
  motion.parameters_.assign({inertia, viscous});
  motion.parameters_.insert(motion.parameters_.end(), parameters_.begin() + friction_end, parameters_.end());
  motion.reported_.assign(motion.parameters_.size(), 1.0);
  motion.offset_.assign(motion.parameters_.size(), 0.0);
  return motion;
}

bool FittedMotion::SetLags(TrajectoryData& data) const {
  const bool recorded = data.times().size() == instants_.size() && data.times() == instants_;
  if (recorded) {
    data.zero_motion_factors = against_;
    return true;
  }
  MotionStates states;
  if (!MakeTrajectoryCost(model_, start_, data)->Motion(parameters_, false, &states)) return false;
  const Eigen::VectorXd against = -states.value[1].array().sign();
  data.zero_motion_factors.assign(against.begin(), against.end());
  return true;
}

std::optional<Eigen::VectorXd> FittedMotion::Readings(const Eigen::VectorXd& instants,
                                                      Eigen::MatrixXd* jacobian) const {
  TrajectoryData data;
  data.quantity = quantity_;
  data.sensor = sensor_;
  data.time.assign(instants.begin(), instants.end());
  data.value.assign(data.time.size(), 0.0);
  data.natural_frequency = 1 / std::sqrt(parameters_[0]);
  data.latest_release = instants[instants.size() - 1];
  if (drifts()) data.zero_motion_factors = data.time;
  data.stop = stop_;
  if (zero_motion_ == ZeroMotion::kLags && !SetLags(data)) return std::nullopt;
  const std::unique_ptr<TrajectoryCost> cost = MakeTrajectoryCost(model_, start_, data);
  Eigen::VectorXd readings;
  if (!cost->Readings(parameters_, &readings, jacobian)) return std::nullopt;
  if (jacobian != nullptr) {
    for (Eigen::Index k = 0; k < jacobian->cols(); ++k) jacobian->col(k) /= reported_[static_cast<std::size_t>(k)];
  }
  return readings;
}

std::optional<Trajectory> FittedMotion::Trace() const {
  const std::size_t size = PhysicalParameters(model_).size();
  const double* const at_start = &parameters_[size];
  const bool is_held = start_ == StartKind::kRelease;
  const Start<double> start{start_, is_held ? at_start[1] : 0, at_start[0], is_held ? 0 : at_start[1]};
  TraceOptions options;
  options.end = instants_[instants_.size() - 1];
  Result<Trajectory> motion = MakeTrajectory(model_, {parameters_.data(), size}, start, options);
  if (!motion) return std::nullopt;
  return *std::move(motion);
}

}  // namespace pendulum
