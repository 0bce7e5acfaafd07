// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/start/fit_options.h"

namespace pendulum {

/// A source of systematic error, and its effect on the fit of one recording.
struct SystematicSource {
  std::string identity;        ///< Recordings with the same identity share the source and its error.
  Eigen::VectorXd powers;      ///< P, for a common factor (C = 1): its power in each parameter; otherwise empty.
  Eigen::MatrixXd pull;        ///< P x C, derivatives of the problem's P scores with respect to the source's C numbers.
  Eigen::MatrixXd covariance;  ///< C x C, of these numbers; for a common factor, relative.
};

/// The sources rig, clock and calibration that have errors, at the solution (MODEL.md eq. (5.3) and (5.4)).
std::vector<SystematicSource> SystematicSources(const Recording& recording, const FitOptions& options,
                                                const FitProblem& problem, const TrajectoryCost& cost,
                                                const Solution& solution);

/// The fit of one or several recordings that the sources affect. P parameters, in the problem's units.
struct SourceContext {
  const std::vector<double>& parameters;
  const std::vector<bool>& fixed;
  std::span<const PriorTerm> priors;
  const Optimum& optimum;
};

/// Covariance of the estimates caused by a source's error, P x P. of_all: every recording of the fit has this source.
Eigen::MatrixXd SourceCovariance(const SystematicSource& source, bool of_all, const SourceContext& context);

/// Covariance of the estimates caused by the errors of rig, clock and calibration (MODEL.md eq. (5.3) and (5.4)). P x P
/// in products of the problem's units; zero rows for fixed parameters.
Eigen::MatrixXd SystematicCovariance(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                     const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum);

}  // namespace pendulum
