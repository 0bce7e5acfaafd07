// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/uncertainty/systematic_errors.h"
#include "pendulum/model/parameter.h"

namespace pendulum {

/// A quantity computed from the parameters, with its propagated standard error.
struct DerivedQuantity {
  std::string name;
  std::string unit;
  double estimate = 0;
  std::optional<double> std_error = std::nullopt;
  std::optional<double> lower95 = std::nullopt, upper95 = std::nullopt;
  SystematicErrors systematic = {};
};

/// Ends of a parameter's confidence interval; one may be missing.
struct IntervalEnds {
  std::optional<double> lower, upper;
};

/// Derived quantities: natural_frequency ω0, damping_ratio ζ, small_angle_period, quality_factor Q = ω0 I / b and
/// decay_time 2 I / b (unless b is 0), and gravity, viscous, coulomb, drag ... over inertia (MODEL.md eq. (6.4)). None
/// depends on the rig.
///
/// infos       The model's parameters, inertia first.
/// parameters  P, in units of the restoring torque G.
/// covariance  P x P, in units of the restoring torque G, zero rows for fixed parameters; nullptr: no standard errors.
/// at_bound    Indices of parameters at a bound.
/// A quantity that depends on a parameter at a bound, or only on fixed parameters, has no standard error.
std::vector<DerivedQuantity> DerivedQuantities(const std::vector<ParameterInfo>& infos,
                                               const std::vector<double>& parameters, const Eigen::MatrixXd* covariance,
                                               const std::vector<int>& at_bound);

/// Sets the intervals of derived quantities from the intervals of their parameters (P, in units of the restoring torque
/// G; other arguments as above). An end is missing if an end of a parameter that it depends on is missing.
void SetDerivedIntervals(const std::vector<ParameterInfo>& infos, const std::vector<double>& parameters,
                         const std::vector<IntervalEnds>& intervals, std::vector<DerivedQuantity>& derived);

/// Adds systematic errors of one source. covariance: P x P, of the parameters in units of the restoring torque G; other
/// arguments as above.
void AddSystematicErrors(const std::vector<ParameterInfo>& infos, const std::vector<double>& parameters,
                         ErrorSource source, const Eigen::MatrixXd& covariance, std::vector<DerivedQuantity>& derived);

}  // namespace pendulum
