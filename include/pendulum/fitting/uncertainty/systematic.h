// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/effects/check_effects.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/solve/solved_fit.h"
#include "pendulum/fitting/uncertainty/systematic_errors.h"

namespace pendulum {

/// What one kind of source does to the estimates. Both matrices are P x P in products of the problem's units.
struct SystematicCovariance {
  ErrorSource kind;
  Eigen::MatrixXd of_estimates;  ///< Of the reported parameters; zero rows for fixed ones.
  Eigen::MatrixXd of_ratios;     ///< Of the parameters over the restoring torque: the error of G belongs to no ratio.
  std::vector<BudgetLine> lines = {};  ///< What it consists of. Lines that the readings inform are not independent.
};

/// The covariances that errors of rig, clocks, calibrations and sensors cause, one for each kind of source that has an
/// error (MODEL.md eq. (5.3), (5.4) and section 16). A source that several recordings share affects all of them
/// together. A clock without a stated error has the plausible one of the recording's sensor_errors. Empty if the
/// optimum is not identifiable. effects: K, of each recording.
std::vector<SystematicCovariance> SystematicCovariances(const SolvedFit& fit,
                                                        const std::vector<const EffectCheck*>& effects,
                                                        const Optimum& optimum);

}  // namespace pendulum
