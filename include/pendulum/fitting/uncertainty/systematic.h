// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/effects/check_effects.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/fitting/uncertainty/systematic_errors.h"

namespace pendulum {

/// A source of systematic error, and its effect on the fit of one recording.
struct SystematicSource {
  ErrorSource kind;
  std::string identity;        ///< Recordings with the same identity share the source and its error.
  Eigen::VectorXd powers;      ///< P, for a common factor (C = 1): its power in each parameter; otherwise empty.
  Eigen::MatrixXd pull;        ///< P x C, derivatives of the problem's P scores with respect to the source's C numbers.
  Eigen::MatrixXd covariance;  ///< C x C, of these numbers; for a common factor, relative.
};

/// The sources rig, clock, calibration and sensor that have errors, at the solution (MODEL.md eq. (5.3), (5.4) and
/// section 16). A clock without a stated error has the plausible one of the recording's sensor_errors.
std::vector<SystematicSource> SystematicSources(const Recording& recording, const FitOptions& options,
                                                const FitProblem& problem, const TrajectoryCost& cost,
                                                const Solution& solution, const EffectCheck& effects);

/// The fit of one or several recordings that the sources affect. P parameters, in the problem's units.
struct SourceContext {
  const std::vector<double>& parameters;
  const std::vector<bool>& fixed;
  std::span<const PriorTerm> priors;
  const Optimum& optimum;
};

/// What one kind of source does to the estimates. Both matrices are P x P in products of the problem's units.
struct SystematicCovariance {
  ErrorSource kind;
  Eigen::MatrixXd of_estimates;  ///< Of the reported parameters; zero rows for fixed ones.
  Eigen::MatrixXd of_ratios;     ///< Of the parameters over the restoring torque: the error of G belongs to no ratio.
};

/// The covariance that a source causes. of_all: every recording of the fit has this source. `source` is of the same P
/// parameters as `context`: its pull has P rows, and its powers have P elements or none. The optimum must be
/// identifiable (optimum.inverse.identifiable), because its inverse information gives the change of the estimates.
SystematicCovariance CovarianceOfSource(const SystematicSource& source, bool of_all, const SourceContext& context);

/// Adds a covariance to that of its kind.
void AddOfKind(SystematicCovariance more, std::vector<SystematicCovariance>& covariances);

/// The covariances that errors of rig, clock, calibration and sensor cause, one for each kind of source that has an
/// error.
std::vector<SystematicCovariance> SystematicCovariances(const Recording& recording, const FitOptions& options,
                                                        const FitProblem& problem, const TrajectoryCost& cost,
                                                        const Solution& solution, const Optimum& optimum,
                                                        const EffectCheck& effects);

}  // namespace pendulum
