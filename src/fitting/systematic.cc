// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/systematic.h"

#include <cmath>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The power of the clock's scale in a parameter's estimate. A rate sensor's clock is its own: what follows from its
/// readings alone does not scale, and angles, which it tells as rate times time, do.
int PowerOfTime(const ParameterInfo& info, Quantity quantity) {
  const auto is_one_of = [&](auto... infos) { return ((info.name == infos.name) || ...); };
  const bool rate = quantity == Quantity::kRate;
  if (is_one_of(kZeroDrift, kBiasDrift)) return -1;
  if (is_one_of(kInitialRate)) return rate ? 0 : -1;
  if (is_one_of(kReleaseAngle, kInitialAngle)) return rate ? 1 : 0;
  if (!info.scales_with_gravity()) return 0;
  if (is_one_of(kInertia)) return 2;
  if (rate) return 1;
  return info.relative_unit == "s^2" ? 2 : info.relative_unit == "s" ? 1 : 0;
}

/// Derivatives of the estimates (P, the problem's units) with respect to the calibration's K coefficients:
/// A^-1 Σ w ∇m ∂value/∂c.
Eigen::MatrixXd FollowCalibration(const Calibration& calibration, const FitProblem& problem, const TrajectoryCost& cost,
                                  const Solution& solution, const Optimum& optimum) {
  const auto size = static_cast<Index>(calibration.coefficients.size());
  const auto free = static_cast<Index>(optimum.free.size());
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(static_cast<Index>(problem.infos.size()), size);
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  if (!cost.Readings(solution.parameters, &readings, &jacobian)) return moved;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(free, size);
  double input = 0;
  for (Index i = 0; i < readings.size(); ++i) {
    const double value = problem.data.value[static_cast<std::size_t>(i)];
    input = calibration.Reading(value, input);
    const double weight = solution.noise.At(value, readings[i]).weight;
    const Eigen::VectorXd row = jacobian.row(i)(optimum.free);
    double power = weight * calibration.RadFromUnit();
    for (Index k = 0; k < size; ++k, power *= input) sums.col(k) += power * row;
  }
  moved(optimum.free, Eigen::all) = optimum.inverse.matrix * sums;
  return moved;
}

}  // namespace

/// One source after the other: the rig's gravity torque is a common factor of inertia and friction; the clock's scale
/// enters by the powers of time in a parameter; the calibration's coefficients move every reading, and the estimates
/// follow as the least squares around the optimum do.
Eigen::MatrixXd SystematicCovariance(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                     const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum,
                                     const Eigen::VectorXd& estimates) {
  const Index size = estimates.size();
  Eigen::VectorXd rig = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd clock = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd units(size);
  for (Index i = 0; i < size; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const ParameterInfo& info = problem.infos[index];
    units[i] = problem.si_per_internal[index];
    if (problem.solve.fixed[index]) continue;
    clock[i] = PowerOfTime(info, recording.quantity) * recording.clock_scale_std_dev / recording.clock_scale;
    if (!options.rig || !info.scales_with_gravity()) continue;
    rig[i] = options.rig->gravity_torque.std_dev / options.rig->gravity_torque.value;
  }
  rig.array() *= estimates.array();
  clock.array() *= estimates.array();
  Eigen::MatrixXd covariance = rig * rig.transpose() + clock * clock.transpose();
  const std::optional<Calibration>& calibration = recording.calibration;
  if (calibration && calibration->covariance.size() > 0 && optimum.inverse.identifiable) {
    const Eigen::MatrixXd moved =
        units.asDiagonal() * FollowCalibration(*calibration, problem, cost, solution, optimum);
    covariance += moved * calibration->covariance * moved.transpose();
  }
  return covariance;
}

}  // namespace pendulum
