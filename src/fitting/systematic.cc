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

/// How the estimates (P, the problem's units) follow a factor 1 + ε that multiplies what parameter i means by 1 + n_i
/// ε: n_i p_i, were all of them free. A value that is held, or known beforehand, in the report's units stays where it
/// is and draws the others along.
Eigen::VectorXd FollowScale(const Eigen::VectorXd& powers, const FitProblem& problem, const TrajectoryCost& cost,
                            const Solution& solution, const Optimum& optimum) {
  const Eigen::Map<const Eigen::VectorXd> p(solution.parameters.data(), powers.size());
  const Eigen::VectorXd scaled = powers.cwiseProduct(p);
  Eigen::VectorXd follows = Eigen::VectorXd::Zero(powers.size());
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(powers.size());
  for (Index i = 0; i < powers.size(); ++i) {
    if (!problem.solve.fixed[static_cast<std::size_t>(i)]) continue;
    pull -= optimum.information.col(i) * scaled[i];
  }
  for (const PriorTerm& prior : cost.priors()) {
    const int k = prior.parameter;
    pull[k] += prior.weight * prior.weight * powers[k] * (2 * (p[k] - prior.mean) + prior.mean);
  }
  if (!optimum.free.empty()) follows(optimum.free) = -optimum.inverse.matrix * pull(optimum.free);
  for (const int i : optimum.free) follows[i] += scaled[i];
  return follows;
}

}  // namespace

/// One source after the other: the rig's gravity torque is a common factor of inertia and friction; the clock's scale
/// enters by the powers of time in a parameter; the calibration's coefficients move every reading, and the estimates
/// follow as the least squares around the optimum do.
Eigen::MatrixXd SystematicCovariance(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                     const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum) {
  const auto size = static_cast<Index>(problem.infos.size());
  Eigen::VectorXd gravity = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd time(size);
  Eigen::VectorXd units(size);
  for (Index i = 0; i < size; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const ParameterInfo& info = problem.infos[index];
    units[i] = problem.si_per_internal[index];
    time[i] = PowerOfTime(info, recording.quantity);
    if (options.rig && info.scales_with_gravity()) gravity[i] = 1;
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  if (!optimum.inverse.identifiable) return covariance;
  const auto add = [&](const Eigen::VectorXd& powers, double relative) {
    if (!(relative > 0)) return;
    const Eigen::VectorXd moved = relative * units.cwiseProduct(FollowScale(powers, problem, cost, solution, optimum));
    covariance += moved * moved.transpose();
  };
  if (options.rig) add(gravity, options.rig->gravity_torque.std_dev / options.rig->gravity_torque.value);
  add(time, recording.clock_scale_std_dev / recording.clock_scale);
  const std::optional<Calibration>& calibration = recording.calibration;
  if (calibration && calibration->covariance.size() > 0) {
    const Eigen::MatrixXd moved =
        units.asDiagonal() * FollowCalibration(*calibration, problem, cost, solution, optimum);
    covariance += moved * calibration->covariance * moved.transpose();
  }
  return covariance;
}

}  // namespace pendulum
