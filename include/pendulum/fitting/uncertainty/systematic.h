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

/// Something that is not known exactly, and how it pulls at the fit of one recording.
struct SystematicSource {
  std::string identity;    ///< Recordings of the same identity share the source, and its error.
  Eigen::VectorXd powers;  ///< P, of a common factor (C = 1): its power in each parameter; empty for another source.
  Eigen::MatrixXd pull;    ///< P x C, by how much the scores of the problem's parameters follow its C numbers.
  Eigen::MatrixXd covariance;  ///< C x C, of these numbers; of a factor relative.
};

/// Rig, clock and calibration, those of them that have errors, at the solution (MODEL.md eq. (24) and (31)).
std::vector<SystematicSource> SystematicSources(const Recording& recording, const FitOptions& options,
                                                const FitProblem& problem, const TrajectoryCost& cost,
                                                const Solution& solution);

/// The fit, of one recording or several, that sources act on. Over P parameters, in the problem's units.
struct SourceContext {
  const std::vector<double>& parameters;
  const std::vector<bool>& fixed;
  std::span<const PriorTerm> priors;
  const Optimum& optimum;
};

/// What a source's error leaves open in the estimates, P x P. of_all: it is that of every recording of the fit.
Eigen::MatrixXd SourceCovariance(const SystematicSource& source, bool of_all, const SourceContext& context);

/// What the errors of rig, clock and calibration leave open in the estimates: their covariance (MODEL.md eq. (24) and
/// (31)), P x P in products of the problem's units; zero rows for what is fixed.
Eigen::MatrixXd SystematicCovariance(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                     const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum);

}  // namespace pendulum
