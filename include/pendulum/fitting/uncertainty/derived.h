// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/uncertainty/systematic_errors.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/parameter.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// A quantity computed from P parameters, with its propagated standard error.
struct DerivedQuantity {
  std::string name;
  std::string unit;
  double estimate = 0;
  std::optional<double> std_error = std::nullopt;
  std::optional<double> lower95 = std::nullopt, upper95 = std::nullopt;
  SystematicErrors systematic = {};
  ParameterRange range = {0, kUnbounded};  ///< Its possible values.
  Eigen::VectorXd gradient = {};           ///< P, for its report's parameters in units of the torque G; or empty.
  bool is_of_recording = false;            ///< It depends on the recorded motion, not on the pendulum alone.
};

/// Ends of a parameter's confidence interval; one may be missing.
struct IntervalEnds {
  std::optional<double> lower, upper;
};

/// Derived quantities: natural_frequency ω0, damping_ratio ζ, small_angle_period, quality_factor Q = ω0 I / b and
/// decay_time 2 I / b (unless b is 0), and gravity, viscous, coulomb, drag ... over inertia (MODEL.md eq. (6.4)). None
/// depends on the rig.
///
/// infos       The model's P parameters, inertia first.
/// parameters  P, in units of the restoring torque G.
std::vector<DerivedQuantity> DerivedQuantities(const std::vector<ParameterInfo>& infos,
                                               const std::vector<double>& parameters);

/// The shares of the losses over the fitted window, viscous_loss_share, dry_loss_share and so on, and over its first
/// whole half swing, viscous_loss_share_first_half_swing (MODEL.md eq. (6.21)). None for a law with one loss, or if
/// nothing is lost. parameters: P; duration: s, from the first sample to the last.
std::vector<DerivedQuantity> LossQuantities(const MotionModel& model, StartKind start,
                                            const std::vector<double>& parameters, double duration);

/// Sets the standard errors of those quantities that depend on no parameter at a bound, and not on fixed parameters
/// alone. covariance: P x P, in units of the restoring torque G, zero rows for fixed parameters. at_bound: indices of
/// parameters at a bound.
void SetDerivedErrors(const Eigen::MatrixXd& covariance, const std::vector<int>& at_bound,
                      std::vector<DerivedQuantity>& derived);

/// Sets the intervals of DerivedQuantities from the intervals of their parameters (P, in units of the restoring torque
/// G). An end is missing if an end of a parameter that it depends on is missing.
void SetDerivedIntervals(const std::vector<ParameterInfo>& infos, const std::vector<double>& parameters,
                         const std::vector<IntervalEnds>& intervals, std::vector<DerivedQuantity>& derived);

/// Sets the intervals of quantities that have a standard error: ± t95 of them, within the possible values.
void SetSymmetricIntervals(double t95, std::vector<DerivedQuantity>& derived);

/// Adds systematic errors of one source. covariance: P x P, of the parameters in units of the restoring torque G.
void AddSystematicErrors(ErrorSource source, const Eigen::MatrixXd& covariance, std::vector<DerivedQuantity>& derived);

}  // namespace pendulum
